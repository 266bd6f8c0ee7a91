// SPDX-License-Identifier: Apache-2.0
#include "mpi/scenario.hpp"

#include <cmath>
#include <limits>

#include "garrison/attacks/registry.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/wire/blake2b.hpp"
#include "mpi/named_files.hpp"
#include "node/daemon/files.hpp"
#include "node/daemon/toml_file.hpp"
#include "partition/families.hpp"

namespace garrison::mpi {
namespace {

using node::Section;

constexpr int kMost = std::numeric_limits<int>::max();
/// Agent-samples of estimates above which summaries are kept unless estimates are asked for.
constexpr double kManyEstimates = 1e7;

int whole(const Section& s, const char* key, int least, std::optional<std::int64_t> otherwise = {}) {
  return static_cast<int>(s.whole(key, least, kMost, otherwise));
}

/// The number of an agent.
int agent_of(const Section& s, const char* key, double value) {
  if (!(value >= 0.0 && value <= kMost && value == std::floor(value)))
    refuse(s.where(key), text(value), "whole numbers of agents, from 0");
  return static_cast<int>(value);
}

/// Values of a filter or an attack; every key that is no parameter has to be in `others`.
ParamMap params_of(const Section& s, std::span<const ParamInfo> infos, std::vector<std::string> others) {
  ParamMap params;
  for (const ParamInfo& info : infos) {
    const std::string& key = info.name;
    others.push_back(key);
    if (!s.has(key)) continue;
    if (std::holds_alternative<bool>(info.initial)) params[key] = s.flag(key, false);
    if (std::holds_alternative<std::int64_t>(info.initial)) params[key] = s.whole(key, -kMost, kMost);
    if (std::holds_alternative<double>(info.initial)) params[key] = s.number(key, -kInfinity, kInfinity);
    if (std::holds_alternative<std::string>(info.initial)) params[key] = s.text(key);
    if (std::holds_alternative<std::vector<double>>(info.initial)) params[key] = s.numbers(key);
  }
  s.only(others);
  return params;
}

Matrix matrix(const Section& s, const char* key, std::size_t columns) {
  const auto rows = s.rows(key);
  Matrix M(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].size() != columns)
      refuse(s.where(key), "a row of " + std::to_string(rows[r].size()) + " numbers",
             std::to_string(columns) + " numbers in every row");
    for (std::size_t c = 0; c < columns; ++c)
      M(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = rows[r][c];
  }
  return M;
}

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

std::unique_ptr<partition::Ground> read_ground(const Section& s, Inputs& inputs) {
  if (!s.has("kind")) {
    s.only({"agents", "edges"});
    if (s.has_section("edges")) {
      const NetcdfInput input = inputs.of(s, "edges");
      return netcdf_network(input, whole(s, "agents", 1), inputs.checksum(input));
    }
    std::vector<Edge> edges;
    const Matrix pairs = matrix(s, "edges", 2);
    for (Eigen::Index k = 0; k < pairs.rows(); ++k)
      edges.emplace_back(agent_of(s, "edges", pairs(k, 0)), agent_of(s, "edges", pairs(k, 1)));
    return partition::listed(Network(whole(s, "agents", 1), edges));
  }
  const std::string kind = s.text("kind");
  if (kind == "grid") {
    s.only({"kind", "rows", "columns"});
    return partition::grid(whole(s, "rows", 1), whole(s, "columns", 1));
  }
  if (kind == "random_geometric") {
    s.only({"kind", "agents", "radius", "seed"});
    return partition::random_geometric(whole(s, "agents", 1), s.number("radius", 0.0, 2.0),
                                       static_cast<std::uint64_t>(s.whole("seed", 0, INT64_MAX, 0)));
  }
  if (kind == "band") {
    s.only({"kind", "agents", "range"});
    return partition::band(whole(s, "agents", 1), whole(s, "range", 1));
  }
  s.only({"kind", "agents"});
  if (kind == "path") return partition::band(whole(s, "agents", 1), 1);
  if (kind == "ring") return partition::ring(whole(s, "agents", 1));
  refuse(s.where("kind"), "\"" + kind + "\"", "one of grid, random_geometric, band, path, ring",
         "other networks are given by agents and edges");
}

void read_filter(const Section& s, Scenario& out) {
  out.family = s.text("name");
  partition::require_family(out.family);
  for (const FamilyInfo& info : families())
    if (info.name == out.family) out.params = params_of(s, info.params, {"name", "label"});
  make_filter(out.family, out.params);  // checks the values
}

void read_attack(const Section& s, RunOptions& run) {
  const std::string kind = s.text("kind");
  for (const AttackInfo& info : attack_infos()) {
    if (info.name != kind) continue;
    const ParamMap params = params_of(s, info.params, {"kind", "agents", "start", "stop", "probability"});
    std::vector<int> agents;
    for (const double id : s.numbers("agents")) agents.push_back(agent_of(s, "agents", id));
    if (agents.empty()) refuse(s.where("agents"), "nobody", "the agents that are attacked");
    AnyAttack attack = make_attack(
        kind,
        Schedule(s.whole("start", 0, kMost, 1), agents, s.whole("stop", 1, INT64_MAX, Schedule::kForever),
                 s.number("probability", 0.0, 1.0, 1.0)),
        params);
    if (attack.measurement) run.attacks.push_back(attack.measurement);
    if (attack.message) run.message_attacks.push_back(attack.message);
    return;
  }
  refuse(s.where("kind"), "\"" + kind + "\"", "an attack of `garrison list attacks`");
}

Vector vector(const Section& s, const char* key, int states) {
  const auto numbers = s.numbers(key);
  if (!numbers.empty() && static_cast<int>(numbers.size()) != states)
    refuse(s.where(key), std::to_string(numbers.size()) + " numbers",
           std::to_string(states) + ", one per state");
  return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

void read_run(const Section& s, Scenario& out) {
  s.only({"steps", "seed", "x0", "start", "start_error", "trial"});
  out.plant.steps = whole(s, "steps", 1);
  out.run.seed = static_cast<std::uint64_t>(s.whole("seed", 0, INT64_MAX, 0));
  out.run.first_trial = static_cast<int>(s.whole("trial", 0, kMostTrials - 1, 0));
  out.plant.x0 = vector(s, "x0", out.states());
  out.run.start = vector(s, "start", out.states());
  out.plant.start_error = s.number("start_error", 0.0, std::numeric_limits<double>::max(), 0.0);
}

void read_link(const Section& s, LinkFaults& link) {
  s.only({"drop", "delay", "delay_rounds"});
  link.drop = s.number("drop", 0.0, 1.0, 0.0);
  link.delay = s.number("delay", 0.0, 1.0, 0.0);
  link.delay_rounds = whole(s, "delay_rounds", 1, 1);
}

void read_output(const Section& s, Scenario& out) {
  s.only({"keep", "every"});
  out.every = whole(s, "every", 1, 1);
  const double kept = static_cast<double>(out.agents()) * (out.plant.steps / out.every);
  const std::string word = s.text("keep", kept <= kManyEstimates ? "estimates" : "summary");
  if (word != "estimates" && word != "summary")
    refuse(s.where("keep"), "\"" + word + "\"", "\"estimates\" or \"summary\"");
  out.kept = word == "estimates" ? Kept::estimates : Kept::summary;
}

}  // namespace

Scenario read_scenario(const std::string& path) {
  const std::string text = node::read_text(path, "a scenario (TOML)");
  const Section file = node::parse_toml(text, path);
  file.only({"title", "model", "network", "filter", "attack", "link", "noise", "run", "partition", "output"});
  Scenario out;
  out.path = path;
  out.fingerprint = wire::checksum(std::as_bytes(std::span(text)));
  Inputs inputs(path);
  out.ground = read_ground(file.section("network"), inputs);
  out.sensors = read_sensors(file.section("model"), out.agents(), inputs);
  out.fingerprint += inputs.checksum();
  out.inputs = inputs.paths();
  if (!out.sensors.C.empty() && static_cast<int>(out.sensors.C.size()) != out.agents())
    refuse(file.section("model").where("C"), std::to_string(out.sensors.C.size()) + " rows",
           std::to_string(out.agents()) + ", one per agent");
  read_filter(file.section("filter"), out);
  read_run(file.section("run"), out);
  if (file.has("attack"))
    for (const Section& one : file.sections("attack")) read_attack(one, out.run);
  for (const Attack& attack : out.run.attacks) attack->schedule().require_agents_below(out.agents());
  for (const auto& attack : out.run.message_attacks) attack->schedule().require_agents_below(out.agents());
  read_link(file.section("link"), out.run.link);
  file.section("noise").only({"law"});
  out.plant.noise = file.section("noise").text("law", "auto");
  const Section parts = file.section("partition");
  parts.only({"method"});
  out.method = parts.text("method", "auto");
  if (out.method != "auto" && out.method != "metis" && out.method != "coordinates" && out.method != "blocks")
    refuse(parts.where("method"), "\"" + out.method + "\"", "auto, metis, coordinates or blocks");
  read_output(file.section("output"), out);
  return out;
}

}  // namespace garrison::mpi
