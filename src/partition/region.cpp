// SPDX-License-Identifier: Apache-2.0
#include "partition/region.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "garrison/engine/plan/ordering.hpp"
#include "partition/surround.hpp"

namespace garrison::partition {
namespace {

std::size_t index_of(std::span<const int> sorted, int id) {
  return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), id) - sorted.begin());
}

/// An order of the own agents (positions in `mine`) in which neighbours are near, ghosts left out.
std::vector<int> near_order(std::span<const int> mine, const Neighbours& neighbours,
                            std::span<const std::int32_t> owner, int rank) {
  std::vector<int> offsets{0};
  std::vector<int> lists;
  lists.reserve(neighbours.lists.size());
  for (std::size_t k = 0; k < mine.size(); ++k) {
    for (const int j : neighbours.of(k))
      if (owner[static_cast<std::size_t>(j)] == rank) lists.push_back(static_cast<int>(index_of(mine, j)));
    offsets.push_back(static_cast<int>(lists.size()));
  }
  return reverse_cuthill_mckee(offsets, lists);
}

/// Sorts by degree inside windows, so that inner loops keep their trip count (engine/plan/consensus.cpp).
void sort_windows(std::vector<int>& order, int interior, const Neighbours& neighbours) {
  constexpr int kWindow = 256;
  const auto degree = [&](int k) { return neighbours.of(static_cast<std::size_t>(k)).size(); };
  const auto own = static_cast<int>(order.size());
  for (int begin = 0; begin < own;) {
    const int end = std::min(begin + kWindow, begin < interior ? interior : own);
    std::stable_sort(order.begin() + begin, order.begin() + end,
                     [&](int a, int b) { return degree(a) < degree(b); });
    begin = end;
  }
}

}  // namespace

std::vector<int> Region::names() const {
  std::vector<int> by_id(ids.size());
  std::iota(by_id.begin(), by_id.end(), 0);
  std::sort(by_id.begin(), by_id.end(), [&](int a, int b) {
    return ids[static_cast<std::size_t>(a)] < ids[static_cast<std::size_t>(b)];
  });
  std::vector<int> names(ids.size());
  for (std::size_t k = 0; k < by_id.size(); ++k)
    names[static_cast<std::size_t>(by_id[k])] = static_cast<int>(k);
  return names;
}

Region region_of(int agents, std::span<const int> mine, const Lists& lists,
                 std::span<const std::int32_t> owner, int rank, int depth) {
  if (mine.empty())
    refuse("partition", "no agent on rank " + std::to_string(rank), "at least one on every rank",
           "use fewer ranks, or another partition");
  Neighbours neighbours = lists(mine);
  Region r;
  r.agents = agents;
  r.own = static_cast<int>(mine.size());
  std::vector<int> order = near_order(mine, neighbours, owner, rank);
  const auto hears_ghosts = [&](int k) {
    const auto heard = neighbours.of(static_cast<std::size_t>(k));
    return std::any_of(heard.begin(), heard.end(),
                       [&](int j) { return owner[static_cast<std::size_t>(j)] != rank; });
  };
  const auto edge =
      std::stable_partition(order.begin(), order.end(), [&](int k) { return !hears_ghosts(k); });
  r.interior = static_cast<int>(edge - order.begin());
  sort_windows(order, r.interior, neighbours);
  r.sorted.resize(mine.size());
  Neighbours own;
  own.lists.reserve(neighbours.lists.size());
  for (std::size_t place = 0; place < order.size(); ++place) {
    const auto k = static_cast<std::size_t>(order[place]);
    r.ids.push_back(mine[k]);
    r.sorted[k] = static_cast<int>(place);
    const auto heard = neighbours.of(k);
    own.lists.insert(own.lists.end(), heard.begin(), heard.end());
    own.offsets.push_back(static_cast<std::int64_t>(own.lists.size()));
  }
  neighbours = {};
  surround(r, std::move(own), lists, owner, rank, depth);
  return r;
}

}  // namespace garrison::partition
