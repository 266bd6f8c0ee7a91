// SPDX-License-Identifier: Apache-2.0
// What happens to the messages of one run: channels that lose them, and agents that lie in them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "garrison/attacks/message.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/channel.hpp"

namespace garrison {

/// Faults of honest links: random, scheduled and recorded ones, in any combination.
struct GARRISON_EXPORT LinkFaults {
  double drop = 0.0;     ///< probability in [0, 1] that a message is lost
  double delay = 0.0;    ///< probability in [0, 1] that a message is late, and therefore lost to its receiver
  int delay_rounds = 1;  ///< >= 1: by how many rounds; one is too late already, so this changes nothing
  std::vector<Cut> cuts = {};
  std::vector<Lost> lost = {};
};

/// What happened to messages during a run. Where nothing can happen to any (a perfect link) none is counted.
struct GARRISON_EXPORT LinkCounters {
  std::int64_t sent = 0;     ///< messages that honest links carried as they were
  std::int64_t lost = 0;     ///< dropped, or withheld by the sender
  std::int64_t late = 0;     ///< of an earlier round when they came, and therefore not delivered
  std::int64_t forged = 0;   ///< delivered with other values than the receiver should have got
  std::int64_t refused = 0;  ///< not delivered because a number was not finite, or beyond kHuge
  LinkCounters& operator+=(const LinkCounters& other);
};

/// Faults and lies of one run. Decides the fate of one message at a time; the engine turns it into slots.
/// Threads: one at a time.
class GARRISON_EXPORT Link {
 public:
  /// @throws InvalidInput when a probability is outside [0, 1], delay_rounds < 1 or an agent does not exist.
  Link(const Network& network, LinkFaults faults, std::vector<std::shared_ptr<const MessageAttack>> attacks,
       std::uint64_t seed, std::uint32_t trial);

  /// Nothing can happen to any message, ever.
  bool perfect() const { return !seeded_.any() && channels_.empty() && attacks_.empty(); }
  /// Samples that an engine must keep messages for, because a liar sends old ones as new.
  int memory() const { return memory_; }
  bool lies(int sender) const { return liar_[static_cast<std::size_t>(sender)] != 0; }

  /// Refuses attacks that such messages have no place for. @throws InvalidInput
  void require(const FieldList& message) const;
  /// What becomes of what each link carries in this round.
  void decide(std::int64_t sample, int round, const Links& links, std::span<Fate> fates) const;
  /// How many samples old what this sender sends is now; 0 = new.
  int age(const Hop& hop) const;
  /// Lets the attacks rewrite the message; false = the sender withholds it.
  bool rewrite(const Hop& hop, const FieldList& message, bool& changed) const;

  LinkCounters counters;

 private:
  /// Calls action(attack, hop with the attack's salt) for those that strike, until it returns false.
  template <class Action>
  bool strike(const Hop& hop, const Action& action) const;

  SeededFaults seeded_;
  std::vector<std::unique_ptr<Channel>> channels_;  // scheduled and recorded faults
  std::vector<std::shared_ptr<const MessageAttack>> attacks_;
  std::vector<char> liar_;
  int memory_ = 0;
  std::uint64_t seed_;
  std::uint32_t trial_;
};

}  // namespace garrison
