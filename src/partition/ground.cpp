// SPDX-License-Identifier: Apache-2.0
#include "partition/ground.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "garrison/wire/blake2b.hpp"

namespace garrison::partition {
namespace {

/// Networks whose lists follow from a formula: `List::of(id, add)` calls add(j) in any order.
template <class List>
class Formula final : public Ground {
 public:
  Formula(int agents, List list, std::string description)
      : agents_(agents), list_(std::move(list)), description_(std::move(description)) {}
  int agents() const override { return agents_; }
  std::string description() const override { return description_; }
  Neighbours neighbours(std::span<const int> ids) const override {
    Neighbours out;
    for (const int id : ids) {
      const std::size_t first = out.lists.size();
      list_(id, [&](int j) { out.lists.push_back(j); });
      std::sort(out.lists.begin() + static_cast<std::ptrdiff_t>(first), out.lists.end());
      out.offsets.push_back(static_cast<std::int64_t>(out.lists.size()));
    }
    return out;
  }

 private:
  int agents_;
  List list_;
  std::string description_;
};
template <class List>
std::unique_ptr<Ground> formula(int agents, List list, std::string description) {
  return std::make_unique<Formula<List>>(agents, std::move(list), std::move(description));
}

class Listed final : public Ground {
 public:
  explicit Listed(Network network) : network_(std::move(network)) {
    if (network_.directed())
      refuse("network", "a directed one", "an undirected one", "ranks send to those that they hear");
  }
  int agents() const override { return network_.agents(); }
  Neighbours neighbours(std::span<const int> ids) const override {
    Neighbours out;
    for (const int id : ids) {
      const auto heard = network_.neighbours(id);
      out.lists.insert(out.lists.end(), heard.begin(), heard.end());
      out.offsets.push_back(static_cast<std::int64_t>(out.lists.size()));
    }
    return out;
  }
  std::string description() const override {
    const auto sum = [](std::span<const int> ids) {
      return std::to_string(wire::checksum(std::as_bytes(ids)));
    };
    return "edges " + std::to_string(agents()) + " " + sum(network_.offsets()) + " " + sum(network_.lists());
  }

 private:
  Network network_;
};

void require_least(const char* which, int value) {
  if (value < 1) refuse(which, std::to_string(value), "at least 1");
}

}  // namespace

std::vector<std::int32_t> Ground::owners(int ranks) const {
  std::vector<std::int32_t> owner(static_cast<std::size_t>(agents()));
  for (std::int64_t i = 0; i < agents(); ++i)
    owner[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(i * ranks / agents());
  return owner;
}

std::unique_ptr<Ground> band(int agents, int range) {
  require_least("agents", agents);
  require_least("range", range);
  return formula(
      agents,
      [agents, range](int i, const auto& add) {
        for (int j = std::max(0, i - range); j <= i + std::min(range, agents - 1 - i); ++j)
          if (j != i) add(j);
      },
      "band " + std::to_string(agents) + " " + std::to_string(range));
}

std::unique_ptr<Ground> ring(int agents) {
  require_least("agents", agents);
  return formula(
      agents,
      [agents](int i, const auto& add) {
        if (agents > 1) add((i + 1) % agents);
        if (agents > 2) add((i + agents - 1) % agents);
      },
      "ring " + std::to_string(agents));
}

std::unique_ptr<Ground> grid(int rows, int columns) {
  require_least("rows", rows);
  require_least("columns", columns);
  if (static_cast<std::int64_t>(rows) * columns > std::numeric_limits<int>::max())
    refuse("rows x columns", text(static_cast<double>(rows) * columns), "fewer than 2^31 agents");
  return formula(
      rows * columns,
      [rows, columns](int i, const auto& add) {
        if (i / columns > 0) add(i - columns);
        if (i % columns > 0) add(i - 1);
        if (i % columns + 1 < columns) add(i + 1);
        if (i / columns + 1 < rows) add(i + columns);
      },
      "grid " + std::to_string(rows) + " " + std::to_string(columns));
}

std::unique_ptr<Ground> listed(Network network) { return std::make_unique<Listed>(std::move(network)); }

Network network_of(const Ground& ground) {
  std::vector<int> all(static_cast<std::size_t>(ground.agents()));
  std::iota(all.begin(), all.end(), 0);
  const Neighbours neighbours = ground.neighbours(all);
  std::vector<Edge> edges;
  for (const int i : all)
    for (const int j : neighbours.of(static_cast<std::size_t>(i)))
      if (j < i) edges.emplace_back(j, i);
  return {ground.agents(), edges};
}

}  // namespace garrison::partition
