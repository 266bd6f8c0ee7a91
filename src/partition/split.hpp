// SPDX-License-Identifier: Apache-2.0
// Which rank has which agent.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "partition/ground.hpp"

namespace garrison::partition {

/// A part may have so many times the agents that it would have if all were equal.
inline constexpr double kMostImbalance = 1.2;

/// Why ranks 0..ranks-1 cannot work with this; empty: they can. Partitioners have returned everything in one
/// part without a word.
std::string unbalanced(std::span<const std::int32_t> owner, int ranks);
/// @throws InvalidInput with the reason, `source` says whose it is
void require_balanced(const std::string& source, std::span<const std::int32_t> owner, int ranks);

/// A partition as bytes and back, for a cache. `description`: of the ground. Empty where the bytes are of
/// another ground or number of ranks, or damaged.
std::vector<std::byte> partition_bytes(std::span<const std::int32_t> owner, int ranks,
                                       const std::string& description);
std::vector<std::int32_t> partition_of(std::span<const std::byte> bytes, int agents, int ranks,
                                       const std::string& description);

/// Agents of rank `rank`, in ascending order.
std::vector<int> agents_of(std::span<const std::int32_t> owner, int rank);

}  // namespace garrison::partition
