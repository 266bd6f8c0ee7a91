// SPDX-License-Identifier: Apache-2.0
// What becomes of a datagram: every one is counted under exactly one name, none is logged.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "garrison/core/envelope.hpp"

namespace garrison::node {

enum class Fate : std::uint8_t {
  taken,       ///< a frame of a live session that was of use
  handshake,   ///< a message of a handshake
  size,        ///< no datagram of ours has this size
  version,     ///< of another version of the wire format
  type,        ///< of an unknown type
  stranger,    ///< names a sender that is no neighbour
  no_session,  ///< for a session that does not exist (any more)
  replay,      ///< seen before, or too old to tell
  tag,         ///< not sealed, or not by the neighbour that it names
  stale,       ///< an initiation that is older than the last one
  busy,        ///< an initiation while our own one, which goes before, is under way
  kind,        ///< sealed by the neighbour, but of no known kind or shape
  late,        ///< of a round that is over
  early,       ///< of a sample after the next one, or a round that does not exist
  duplicate,   ///< the same body again
  conflict,    ///< another body for a place that is taken: the sender contradicts itself
  body_size,   ///< bodies that the family refuses
  number,
  flag,
  set,
  off,  ///< a message while nobody takes part, or a request for what is not kept
};
inline constexpr std::size_t kFates = static_cast<std::size_t>(Fate::off) + 1;

constexpr std::string_view word(Fate fate) {
  constexpr std::string_view words[] = {
      "taken",     "handshake", "size",      "version", "type", "stranger", "no_session",
      "replay",    "tag",       "stale",     "busy",    "kind", "late",     "early",
      "duplicate", "conflict",  "body_size", "number",  "flag", "set",      "off"};
  static_assert(std::size(words) == kFates);
  return words[static_cast<std::size_t>(fate)];
}

/// What the agent says of a body, as the fate of its frame.
constexpr Fate fate_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return Fate::taken;
    case Refusal::stranger:
      return Fate::stranger;
    case Refusal::late:
      return Fate::late;
    case Refusal::early:
      return Fate::early;
    case Refusal::duplicate:
      return Fate::duplicate;
    case Refusal::size:
      return Fate::body_size;
    case Refusal::number:
      return Fate::number;
    case Refusal::flag:
      return Fate::flag;
    case Refusal::set:
      return Fate::set;
    default:
      return Fate::off;
  }
}

/// How many of each.
/// Threads: one at a time.
class Fates {
 public:
  void count(Fate fate) noexcept { ++counts_[static_cast<std::size_t>(fate)]; }
  std::int64_t operator[](Fate fate) const noexcept { return counts_[static_cast<std::size_t>(fate)]; }
  std::int64_t refused() const noexcept {
    std::int64_t all = 0;
    for (std::size_t k = static_cast<std::size_t>(Fate::size); k < kFates; ++k) all += counts_[k];
    return all;
  }

 private:
  std::array<std::int64_t, kFates> counts_{};
};

}  // namespace garrison::node
