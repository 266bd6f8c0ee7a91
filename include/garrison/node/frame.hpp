// SPDX-License-Identifier: Apache-2.0
// The datagrams of version 1, all numbers little-endian (docs/node.md has them as tables). The outer header
// is readable and authenticated, the inner one is sealed.
//
//   1 initiation  type, version, sender u16, stamp i64, Noise message 1 with 20 bytes, mac 16      96
//   2 response    type, version, sender u16, receiver index u32, Noise message 2 with 4, mac 16    76
//   3 data        type, version, sender u16, receiver index u32, counter u64, sealed {inner, body} 52 + body
#pragma once

#include "garrison/node/bytes.hpp"

namespace garrison::node {

inline constexpr std::uint8_t kWireVersion = 1;
inline constexpr std::size_t kMac = 16;
inline constexpr std::size_t kTag = 16;
inline constexpr std::size_t kOuter = 16;
inline constexpr std::size_t kInner = 20;
/// Fits every path of IPv6 (1280) with its headers.
inline constexpr std::size_t kMostDatagram = 1232;
inline constexpr std::size_t kLeastData = kOuter + kInner + kTag;
inline constexpr std::size_t kInitiation = 96;
inline constexpr std::size_t kResponse = 76;
/// A body beyond this travels in several frames.
inline constexpr std::size_t kFragment = 1120;
static_assert(kLeastData + kFragment <= kMostDatagram);

enum class Type : std::uint8_t { initiation = 1, response = 2, data = 3 };
enum class Kind : std::uint8_t { message = 1, want = 2, statement = 3, alive = 9 };

struct Datagram {
  std::array<std::byte, kMostDatagram> bytes;
  std::size_t size = 0;
  Bytes view() const noexcept { return {bytes.data(), size}; }
};

/// The sealed header of a data frame.
struct Inner {
  static constexpr std::int32_t kNoEcho = INT32_MIN;

  Kind kind = Kind::alive;
  std::uint8_t fragment = 0;  ///< 0..63
  bool more = false;          ///< fragments follow
  std::uint16_t round = 0;
  std::int64_t sample = 0;
  std::int32_t phase = 0;       ///< sender's microseconds since the begin of the sample, when sent
  std::int32_t echo = kNoEcho;  ///< what the sender last measured of us: its phase - ours

  void write(std::byte* at) const noexcept {
    wire::store(at, static_cast<std::uint8_t>(kind));
    wire::store(at + 1, static_cast<std::uint8_t>((fragment & 63U) | (more ? 128U : 0U)));
    wire::store(at + 2, round);
    wire::store(at + 4, static_cast<std::uint64_t>(sample));
    wire::store(at + 12, static_cast<std::uint32_t>(phase));
    wire::store(at + 16, static_cast<std::uint32_t>(echo));
  }
  static Inner read(const std::byte* at) noexcept {
    Inner inner;
    inner.kind = static_cast<Kind>(wire::load<std::uint8_t>(at));
    const auto part = wire::load<std::uint8_t>(at + 1);
    inner.fragment = part & 63U;
    inner.more = (part & 128U) != 0;
    inner.round = wire::load<std::uint16_t>(at + 2);
    inner.sample = static_cast<std::int64_t>(wire::load<std::uint64_t>(at + 4));
    inner.phase = static_cast<std::int32_t>(wire::load<std::uint32_t>(at + 12));
    inner.echo = static_cast<std::int32_t>(wire::load<std::uint32_t>(at + 16));
    return inner;
  }
};

/// Type, version and sender: what every datagram begins with.
inline void write_head(std::byte* at, Type type, int sender) noexcept {
  wire::store(at, static_cast<std::uint8_t>(type));
  wire::store(at + 1, kWireVersion);
  wire::store(at + 2, static_cast<std::uint16_t>(sender));
}
/// Who a datagram of at least four bytes says it is from. Nothing is proved by that.
inline int sender_of(Bytes datagram) noexcept { return wire::load<std::uint16_t>(datagram.data() + 2); }

}  // namespace garrison::node
