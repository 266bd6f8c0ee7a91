// SPDX-License-Identifier: Apache-2.0
#include "mpi/network_and_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "garrison/core/error.hpp"
#include "mpi/values.hpp"

namespace garrison::mpi {

partition::Sensors read_sensors(const Section& s, int agents, Inputs& inputs) {
  s.only({"A", "C", "rows", "rows_seed", "process_bound", "measurement_bound", "process_covariance",
          "measurement_covariance"});
  partition::Sensors out;
  out.A = matrix(s, "A", s.rows("A").size());
  if (out.A.rows() == 0) refuse(s.where("A"), "no matrix", "A, n x n, row by row");
  if (s.has("C") == s.has("rows"))
    refuse(s.where("C"), s.has("C") ? "C and rows" : "neither C nor rows",
           "one of C (a row per agent, or { file = .. }) and rows = \"unit\" (drawn)");
  if (s.has_section("C")) {
    out.rows_read = netcdf_column(inputs.of(s, "C"), agents, static_cast<int>(out.A.rows()));
  } else if (s.has("C")) {
    const Matrix C = matrix(s, "C", static_cast<std::size_t>(out.A.rows()));
    for (Eigen::Index i = 0; i < C.rows(); ++i) out.C.push_back(C.row(i));
  } else if (s.text("rows") != "unit") {
    refuse(s.where("rows"), "\"" + s.text("rows") + "\"", "\"unit\": random rows of length 1");
  }
  out.seed = static_cast<std::uint64_t>(s.whole("rows_seed", 0, kMost, 0));
  const auto known = [&](const char* key) {
    return s.has(key) ? s.number(key, 0.0, std::numeric_limits<double>::max()) : kNaN;
  };
  const auto each = [&](const char* key, double& same, std::shared_ptr<const partition::Column>& read) {
    if (s.has_section(key))
      read = netcdf_column(inputs.of(s, key), agents, 0);
    else
      same = known(key);
  };
  out.process_bound = known("process_bound");
  each("measurement_bound", out.measurement_bound, out.bounds_read);
  each("measurement_covariance", out.measurement_variance, out.variances_read);
  if (const double variance = known("process_covariance"); !std::isnan(variance))
    out.process_covariance = variance * Matrix::Identity(out.A.rows(), out.A.rows());
  return out;
}

namespace {

/// Expected share of a unit square that is nearer than `radius` to a point of it, both uniform.
double near_share(double radius) {
  if (radius >= 1.0) return 1.0;  // 0.975 and more
  return radius * radius * (std::numbers::pi - radius * (8.0 / 3.0 - radius / 2.0));
}

/// Refuses neighbours that no memory holds; `heard`: by each of `agents` agents.
void require_lists(const std::string& where, const std::string& got, double agents, double heard,
                   const Bytes& bytes) {
  require_memory(where, got + ", some " + amount(std::llround(heard), "neighbour") + " each",
                 agents * (bytes.agent + heard * bytes.heard));
}

}  // namespace

std::unique_ptr<partition::Ground> read_ground(const Section& s, Inputs& inputs, const Bytes& bytes) {
  const auto agents = [&] {
    const int count = whole(s, "agents", 1);
    require_memory(s.where("agents"), std::to_string(count), bytes.agent * count);
    return count;
  };
  if (!s.has("kind")) {
    if (!s.has("edges"))
      refuse(s.where("kind"), "neither kind nor edges",
             "kind = grid, random_geometric, band, path or ring, or agents and edges");
    s.only({"agents", "edges"});
    if (s.has_section("edges")) {
      const NetcdfInput input = inputs.of(s, "edges");
      return netcdf_network(input, agents(), inputs.checksum(input));
    }
    std::vector<Edge> edges;
    const Matrix pairs = matrix(s, "edges", 2);
    for (Eigen::Index k = 0; k < pairs.rows(); ++k)
      edges.emplace_back(agent_of(s, "edges", pairs(k, 0)), agent_of(s, "edges", pairs(k, 1)));
    return partition::listed(Network(agents(), edges));
  }
  const std::string kind = s.text("kind");
  if (kind == "grid") {
    s.only({"kind", "rows", "columns"});
    const int rows = whole(s, "rows", 1);
    const int columns = whole(s, "columns", 1);
    require_memory(s.where("rows"), std::to_string(rows) + " x " + std::to_string(columns) + " agents",
                   bytes.agent * rows * columns);
    return partition::grid(rows, columns);
  }
  if (kind == "random_geometric") {
    s.only({"kind", "agents", "radius", "seed"});
    const int count = agents();
    const double radius = s.number("radius", 0.0, 2.0);
    require_lists(s.where("radius"), text(radius), count, near_share(radius) * count, bytes);
    const auto seed = static_cast<std::uint64_t>(s.whole("seed", 0, INT64_MAX, 0));
    return placed(s, "radius", [&] { return partition::random_geometric(count, radius, seed); });
  }
  if (kind == "band") {
    s.only({"kind", "agents", "range"});
    const int count = agents();
    const int range = whole(s, "range", 1);
    require_lists(s.where("range"), std::to_string(range), count, std::min(2.0 * range, count - 1.0), bytes);
    return partition::band(count, range);
  }
  if (kind != "path" && kind != "ring")
    refuse(s.where("kind"), "\"" + kind + "\"", "one of grid, random_geometric, band, path, ring",
           "other networks are given by agents and edges");
  s.only({"kind", "agents"});
  return kind == "ring" ? partition::ring(agents()) : partition::band(agents(), 1);
}

}  // namespace garrison::mpi
