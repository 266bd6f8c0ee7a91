// SPDX-License-Identifier: Apache-2.0
#include "mpi/netcdf_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "garrison/core/error.hpp"
#include "mpi/netcdf_file.hpp"

namespace garrison::mpi {
namespace {

/// Rows that are read at a time.
constexpr std::int64_t kRows = std::int64_t{1} << 18;

class Edges final : public partition::Ground {
 public:
  Edges(NetcdfInput input, int agents, std::uint64_t checksum)
      : input_(std::move(input)), agents_(agents), checksum_(checksum) {
    static_cast<void>(opened());
  }
  int agents() const override { return agents_; }
  std::string description() const override {
    return "netcdf " + std::to_string(agents_) + " " + input_.variable + " " + std::to_string(checksum_);
  }
  partition::Neighbours neighbours(std::span<const int> ids) const override {
    std::vector<std::int32_t> wanted(static_cast<std::size_t>(agents_), -1);  // place in `ids`
    for (std::size_t k = 0; k < ids.size(); ++k)
      wanted[static_cast<std::size_t>(ids[k])] = static_cast<std::int32_t>(k);
    std::vector<std::pair<std::int32_t, int>> links;
    each([&](int a, int b) {
      const std::int32_t place = wanted[static_cast<std::size_t>(a)];
      if (place >= 0) links.emplace_back(place, b);
    });
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
    partition::Neighbours out;
    out.lists.reserve(links.size());
    for (std::size_t k = 0, next = 0; k < ids.size(); ++k) {
      for (; next < links.size() && links[next].first == static_cast<std::int32_t>(k); ++next)
        out.lists.push_back(links[next].second);
      out.offsets.push_back(static_cast<std::int64_t>(out.lists.size()));
    }
    return out;
  }

 private:
  std::unique_ptr<NetcdfVariable> opened() const {
    auto edges = std::make_unique<NetcdfVariable>(input_.path, input_.variable);
    const std::int64_t sizes[] = {-1, 2};
    edges->require(sizes, true, "edges x 2, the two agents of each edge");
    return edges;
  }
  /// Calls heard(a, b) and heard(b, a) for every edge, all of them checked.
  template <class Heard>
  void each(const Heard& heard) const {
    const auto edges = opened();
    std::vector<int> pairs(static_cast<std::size_t>(2 * std::min(kRows, edges->rows())));
    for (std::int64_t first = 0; first < edges->rows(); first += kRows) {
      const std::int64_t count = std::min(kRows, edges->rows() - first);
      edges->read(first, count, pairs);
      for (std::int64_t k = 0; k < count; ++k) {
        const int a = pairs[static_cast<std::size_t>(2 * k)];
        const int b = pairs[static_cast<std::size_t>(2 * k + 1)];
        if (a < 0 || b < 0 || a >= agents_ || b >= agents_ || a == b)
          refuse(edges->where() + ", row " + std::to_string(first + k),
                 "(" + std::to_string(a) + ", " + std::to_string(b) + ")",
                 "two different agents in 0.." + std::to_string(agents_ - 1), "agents are numbered from 0");
        heard(a, b);
        heard(b, a);
      }
    }
  }

  NetcdfInput input_;
  int agents_;
  std::uint64_t checksum_;
};

class Rows final : public partition::Column {
 public:
  Rows(NetcdfInput input, int agents, int width) : input_(std::move(input)), agents_(agents), width_(width) {
    static_cast<void>(opened());
  }
  std::vector<double> of(std::span<const int> ids) const override {
    const auto rows = opened();
    const auto width = static_cast<std::size_t>(std::max(1, width_));
    std::vector<double> read(width * static_cast<std::size_t>(std::min<std::int64_t>(kRows, agents_)));
    std::vector<double> out;
    out.reserve(width * ids.size());
    for (std::size_t k = 0; k < ids.size();) {
      const std::int64_t first = ids[k];
      const auto end =
          std::lower_bound(ids.begin() + static_cast<std::ptrdiff_t>(k), ids.end(), first + kRows);
      rows->read(first, *(end - 1) + 1 - first, read);
      for (; k < static_cast<std::size_t>(end - ids.begin()); ++k)
        for (std::size_t c = 0; c < width; ++c) {
          const double value = read[static_cast<std::size_t>(ids[k] - first) * width + c];
          if (!std::isfinite(value) || (width_ == 0 && value < 0.0))
            refuse(rows->where() + ", agent " + std::to_string(ids[k]), text(value),
                   width_ == 0 ? "a finite number >= 0" : "a finite number");
          out.push_back(value);
        }
    }
    return out;
  }

 private:
  std::unique_ptr<NetcdfVariable> opened() const {
    auto rows = std::make_unique<NetcdfVariable>(input_.path, input_.variable);
    const std::int64_t sizes[] = {agents_, width_};
    const std::string agents = std::to_string(agents_);
    if (width_ > 0)
      rows->require(sizes, false, agents + " x " + std::to_string(width_) + ", a row per agent");
    else
      rows->require(std::span(sizes).first(1), false, agents + ", one per agent");
    return rows;
  }

  NetcdfInput input_;
  int agents_;
  int width_;
};

}  // namespace

std::unique_ptr<partition::Ground> netcdf_network(const NetcdfInput& input, int agents,
                                                  std::uint64_t checksum) {
  return std::make_unique<Edges>(input, agents, checksum);
}

std::shared_ptr<const partition::Column> netcdf_column(const NetcdfInput& input, int agents, int width) {
  return std::make_shared<Rows>(input, agents, width);
}

}  // namespace garrison::mpi
