// SPDX-License-Identifier: Apache-2.0
// What the network does to messages: loss, delay, and agents that lie.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "garrison/attacks/message.hpp"
#include "garrison/core/network.hpp"

namespace garrison {

/// Random faults of honest links; every message meets its fate independently.
struct GARRISON_EXPORT LinkFaults {
  double drop = 0.0;     ///< probability in [0, 1] that a message is lost
  double delay = 0.0;    ///< probability in [0, 1] that a message is late by `delay_rounds`
  int delay_rounds = 1;  ///< >= 1; the receiver sees the sender's message of that many rounds ago
};

/// What happened to messages during a run.
struct GARRISON_EXPORT LinkCounters {
  std::int64_t sent = 0;     ///< messages that honest links carried as they were
  std::int64_t lost = 0;     ///< dropped, late beyond the start, or withheld by the sender
  std::int64_t late = 0;     ///< delivered, but an old one
  std::int64_t forged = 0;   ///< delivered with other values than the receiver should have got
  std::int64_t refused = 0;  ///< not delivered because a value was not finite
  LinkCounters& operator+=(const LinkCounters& other);
};

/// Faults and lies of one run. Decides the fate of one message at a time; the engine turns it into slots.
class GARRISON_EXPORT Link {
 public:
  /// @throws InvalidInput when a probability is outside [0, 1], delay_rounds < 1 or an agent does not exist.
  Link(const Network& network, LinkFaults faults, std::vector<std::shared_ptr<const MessageAttack>> attacks,
       std::uint64_t seed, std::uint32_t trial);

  /// Nothing can happen to any message, ever.
  bool perfect() const { return faults_.drop <= 0.0 && faults_.delay <= 0.0 && attacks_.empty(); }
  /// Rounds that an engine must keep messages for.
  int memory() const { return faults_.delay > 0.0 ? faults_.delay_rounds : 0; }
  bool lies(int sender) const { return liar_[static_cast<std::size_t>(sender)] != 0; }

  enum class Fate : std::uint8_t { delivered, lost, late };
  Fate fate(const Hop& hop) const;
  /// Lets the attacks rewrite `values`; false = the sender withholds the message.
  bool rewrite(const Hop& hop, std::span<double> values, bool& changed) const;

  LinkCounters counters;

 private:
  LinkFaults faults_;
  std::vector<std::shared_ptr<const MessageAttack>> attacks_;
  std::vector<char> liar_;
  std::uint64_t seed_;
  std::uint32_t trial_;
};

}  // namespace garrison
