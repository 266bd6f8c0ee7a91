// SPDX-License-Identifier: Apache-2.0
// Who sent a message, and when: the driver's business, never a family's.
#pragma once

#include <cstdint>
#include <string_view>

namespace garrison {

/// On a node it comes from the authenticated header of a frame. A driver delivers only messages of the sample
/// and round that their receiver is in; older ones are lost, and counted as late.
struct Envelope {
  int sender = 0;
  std::int64_t sample = 0;
  int round = 0;  ///< 0..rounds-1
  bool operator==(const Envelope&) const = default;
};

/// Why a message, a snapshot or a call was not taken; `none` = it was.
enum class Refusal : std::uint8_t {
  none,
  stranger,   ///< the sender is not a neighbour
  late,       ///< of an earlier sample or round
  early,      ///< of a later sample than the next, or of a round that does not exist
  duplicate,  ///< this sender's message of that sample and round is here already
  size,       ///< the body is too short or too long
  number,     ///< a number that is not finite, or too large
  flag,       ///< a flag that is neither 0 nor 1, or a count out of range
  set,        ///< a set with members that do not exist, out of order, or too many of them
  foreign,    ///< of another family, design, agent or version
  damaged,    ///< the checksum does not match
  order,      ///< a call out of turn, e.g. sense before all rounds of the last sample
};

/// One or two words, as counters and errors name it.
constexpr std::string_view word(Refusal refusal) {
  constexpr std::string_view words[] = {"taken",  "stranger", "late", "early",   "duplicate", "size",
                                        "number", "flag",     "set",  "foreign", "damaged",   "order"};
  return words[static_cast<int>(refusal)];
}

}  // namespace garrison
