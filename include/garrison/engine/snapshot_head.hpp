// SPDX-License-Identifier: Apache-2.0
// What stands before and behind an agent's state in a snapshot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "garrison/core/envelope.hpp"
#include "garrison/wire/blake2b.hpp"
#include "garrison/wire/bytes.hpp"

namespace garrison {

/// Whose state it is, of which design and time; `fresh`: who has just started in a running network, and says
/// nothing before it has heard the others.
struct SnapshotHead {
  static constexpr std::size_t kBytes = 40;
  static constexpr std::size_t kChecksum = 8;

  /// All that is not the agent's state.
  static constexpr std::size_t kAround = kBytes + kChecksum;
  /// The state in a snapshot.
  template <class Byte>
  static std::span<Byte> state_in(std::span<Byte> snapshot) noexcept {
    return snapshot.subspan(kBytes, snapshot.size() - kAround);
  }

  int id;
  std::uint64_t design;
  std::int64_t t;
  std::int64_t resets;
  bool fresh;

  /// `snapshot` begins with it and ends with the checksum of all before.
  void write(std::span<std::byte> snapshot) const noexcept {
    std::byte* const at = snapshot.data();
    wire::store(at, kMagic);
    wire::store(at + 4, static_cast<std::uint32_t>(id));
    wire::store(at + 8, design);
    wire::store(at + 16, static_cast<std::uint64_t>(t));
    wire::store(at + 24, static_cast<std::uint64_t>(resets));
    wire::store(at + 32, std::uint64_t{fresh});
    const std::size_t end = snapshot.size() - kChecksum;
    wire::store(at + end, wire::checksum(snapshot.first(end)));
  }
  /// Reads t, resets and fresh of a snapshot of this agent and design; or why not (foreign, damaged).
  Refusal read(std::span<const std::byte> snapshot) noexcept {
    const std::byte* const at = snapshot.data();
    if (wire::load<std::uint32_t>(at) != kMagic || wire::load<std::uint64_t>(at + 8) != design ||
        wire::load<std::uint32_t>(at + 4) != static_cast<std::uint32_t>(id))
      return Refusal::foreign;
    const std::size_t end = snapshot.size() - kChecksum;
    if (wire::load<std::uint64_t>(at + end) != wire::checksum(snapshot.first(end))) return Refusal::damaged;
    t = static_cast<std::int64_t>(wire::load<std::uint64_t>(at + 16));
    resets = static_cast<std::int64_t>(wire::load<std::uint64_t>(at + 24));
    const auto flag = wire::load<std::uint64_t>(at + 32);
    if (flag > 1) return Refusal::damaged;
    fresh = flag == 1;
    return Refusal::none;
  }

 private:
  static constexpr std::uint32_t kMagic = 0x32535047;  // "GPS2"
};

}  // namespace garrison
