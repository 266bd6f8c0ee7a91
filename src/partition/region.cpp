// SPDX-License-Identifier: Apache-2.0
#include "partition/region.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "garrison/engine/plan/ordering.hpp"

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

/// Public ids of the ghosts by owner, and the places of what each of their owners hears.
void find_ghosts(Region& r, std::span<const int> mine, const Neighbours& neighbours,
                 std::span<const std::int32_t> owner, int rank) {
  std::vector<std::pair<int, int>> ghosts;  // (owner, public id)
  std::vector<std::pair<int, int>> sent;    // (peer, public id)
  for (std::size_t k = 0; k < mine.size(); ++k)
    for (const int j : neighbours.of(k)) {
      const int other = owner[static_cast<std::size_t>(j)];
      if (other == rank) continue;
      ghosts.emplace_back(other, j);
      sent.emplace_back(other, mine[k]);
    }
  for (auto* all : {&ghosts, &sent}) {
    std::sort(all->begin(), all->end());
    all->erase(std::unique(all->begin(), all->end()), all->end());
  }
  const auto count = [](const std::vector<std::pair<int, int>>& all, int peer) {
    return static_cast<int>(
        std::count_if(all.begin(), all.end(), [&](const auto& one) { return one.first == peer; }));
  };
  for (const auto& [peer, id] : ghosts) {
    if (r.routes.peers.empty() || r.routes.peers.back() != peer) r.routes.peers.push_back(peer);
    r.ids.push_back(id);
  }
  for (const int peer : r.routes.peers) {
    r.routes.sends.push_back(count(sent, peer));
    r.routes.receives.push_back(count(ghosts, peer));
  }
  for (const auto& [peer, id] : sent) r.packed.push_back(r.sorted[index_of(mine, id)]);
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

Region region_of(int agents, std::span<const int> mine, const Neighbours& neighbours,
                 std::span<const std::int32_t> owner, int rank) {
  if (mine.empty())
    refuse("partition", "no agent on rank " + std::to_string(rank), "at least one on every rank",
           "use fewer ranks, or another partition");
  if (neighbours.lists.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    refuse("partition", std::to_string(neighbours.lists.size()) + " links on rank " + std::to_string(rank),
           "fewer than 2^31", "use more ranks");
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
  for (std::size_t place = 0; place < order.size(); ++place) {
    r.ids.push_back(mine[static_cast<std::size_t>(order[place])]);
    r.sorted[static_cast<std::size_t>(order[place])] = static_cast<int>(place);
  }
  find_ghosts(r, mine, neighbours, owner, rank);
  std::vector<std::pair<int, std::int32_t>> ghosts;  // (public id, place), sorted
  for (int place = r.own; place < r.places(); ++place)
    ghosts.emplace_back(r.ids[static_cast<std::size_t>(place)], place);
  std::sort(ghosts.begin(), ghosts.end());
  r.first.push_back(0);
  r.heard.reserve(neighbours.lists.size());
  for (const int k : order) {
    for (const int j : neighbours.of(static_cast<std::size_t>(k))) {
      const bool here = owner[static_cast<std::size_t>(j)] == rank;
      r.heard.push_back(here ? r.sorted[index_of(mine, j)]
                             : std::lower_bound(ghosts.begin(), ghosts.end(), std::pair(j, 0))->second);
    }
    r.first.push_back(r.heard.size());
  }
  return r;
}

}  // namespace garrison::partition
