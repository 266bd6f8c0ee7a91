// SPDX-License-Identifier: Apache-2.0
// Words that everything of a node shares.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "garrison/wire/bytes.hpp"

namespace garrison::node {

using Bytes = std::span<const std::byte>;
using Room = std::span<std::byte>;
using Key = std::array<std::byte, 32>;
/// Microseconds: since 1970 (wall), or since any fixed moment (steady).
using Micros = std::int64_t;

/// One moment on both clocks. Slots and deadlines are wall time, waiting is steady time; that the two drift
/// apart by a jump is how a stepped clock shows.
struct Instant {
  Micros wall = 0;
  Micros steady = 0;
};

/// Fresh random keys: the system's in a node, seeded ones in a simulation.
/// Threads: one at a time.
class Random {
 public:
  virtual ~Random() = default;
  virtual Key key() noexcept = 0;
};

inline void copy(Bytes from, std::byte* to) noexcept { std::copy(from.begin(), from.end(), to); }

}  // namespace garrison::node
