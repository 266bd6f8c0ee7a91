// SPDX-License-Identifier: Apache-2.0
// The part of a network that one rank has: its own agents, and ghosts, those of other ranks that they hear.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "garrison/core/error.hpp"
#include "partition/exchange.hpp"

namespace garrison::partition {

/// Neighbours of some agents in public ids, each list sorted: those of the k-th agent are
/// lists[offsets[k]] .. lists[offsets[k + 1] - 1].
struct Neighbours {
  std::vector<std::int64_t> offsets{0};
  std::vector<int> lists;
  std::span<const int> of(std::size_t k) const {
    return std::span(lists).subspan(static_cast<std::size_t>(offsets[k]),
                                    static_cast<std::size_t>(offsets[k + 1] - offsets[k]));
  }
};

/// Who hears whom, asked for some agents: their lists, in the order in which they are asked for.
using Lists = std::function<Neighbours(std::span<const int>)>;

/// Places 0..interior-1 hear own agents only, interior..own-1 also ghosts; own.. are the ghosts, ring by
/// ring: those that own agents hear, those that these hear, ..; in a ring by owner and then by public id.
/// Within the own agents, places of neighbours are near each other. Threads: constant once made; any number
/// may share it.
struct Region {
  int agents = 0;                     ///< of the whole network
  int interior = 0;                   ///< places
  int own = 0;                        ///< places
  std::vector<int> rings;             ///< places within 0, 1, .. hops of own agents; the last one: all
  std::vector<int> ids;               ///< public id at each place, ghosts included
  std::vector<int> sorted;            ///< places of own agents in ascending order of public ids
  std::vector<std::size_t> first;     ///< listed() + 1: where the list of each place begins in `heard`
  std::vector<std::int32_t> heard;    ///< places, each list in ascending order of public ids
  std::vector<std::int32_t> packed;   ///< places of what is sent, peer by peer
  std::vector<std::int32_t> arrival;  ///< places of what is received; own, own + 1, .. where depth() is 1
  Routes routes;

  int places() const { return static_cast<int>(ids.size()); }
  int ghosts() const { return places() - own; }
  /// Hops to the farthest ghosts: rounds that one exchange is enough for.
  int depth() const { return static_cast<int>(rings.size()) - 1; }
  /// Places whose neighbours are all here: all but the outermost ring.
  int listed() const { return rings[rings.size() - 2]; }
  int degree(int place) const {
    const auto k = static_cast<std::size_t>(place);
    return static_cast<int>(first[k + 1] - first[k]);
  }
  /// Place in the ascending order of all public ids here, own and ghosts: names that keep their order.
  std::vector<int> names() const;
};

/// `mine`: public ids of this rank in ascending order; `lists`: of an undirected network of `agents` agents;
/// `owner[j]`: rank of agent j; `depth` >= 1: hops to the farthest ghosts. @throws InvalidInput when this
/// rank has no agent
Region region_of(int agents, std::span<const int> mine, const Lists& lists,
                 std::span<const std::int32_t> owner, int rank, int depth = 1);

}  // namespace garrison::partition
