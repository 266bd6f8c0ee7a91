// SPDX-License-Identifier: Apache-2.0
// Who hears whom, asked for some agents at a time: no rank needs the lists of all.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "garrison/core/network.hpp"
#include "partition/region.hpp"

namespace garrison::partition {

/// An undirected network that is generated agent by agent, or given as a whole.
/// Threads: constant once made; any number may share it.
class Ground {
 public:
  virtual ~Ground() = default;
  virtual int agents() const = 0;
  /// Of the agents `ids`, in ascending order; the lists of `Network` of the same name and numbers.
  virtual Neighbours neighbours(std::span<const int> ids) const = 0;
  /// A rank for each agent such that neighbours are mostly on the same one, from ids or coordinates alone.
  virtual std::vector<std::int32_t> owners(int ranks) const;
  /// One line that says which network it is: equal lines, equal networks.
  virtual std::string description() const = 0;
};

/// i and j hear each other when |i - j| <= range. @throws InvalidInput when agents or range < 1
std::unique_ptr<Ground> band(int agents, int range);
/// @throws InvalidInput when agents < 1
std::unique_ptr<Ground> ring(int agents);
/// @throws InvalidInput when rows or columns < 1
std::unique_ptr<Ground> grid(int rows, int columns);
/// Points uniform in the unit square, as Network::random_geometric has them. @throws InvalidInput as that
/// does
std::unique_ptr<Ground> random_geometric(int agents, double radius, std::uint64_t seed);
/// A network that every rank holds. @throws InvalidInput when directed
std::unique_ptr<Ground> listed(Network network);

/// The whole of it, for designs that need it.
Network network_of(const Ground& ground);

}  // namespace garrison::partition
