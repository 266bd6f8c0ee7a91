// SPDX-License-Identifier: Apache-2.0
// Agents that lie: attacks on the messages they send.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "garrison/attacks/schedule.hpp"

namespace garrison {

/// One message on its way.
struct Hop {
  std::int64_t t;
  int round;
  int sender;
  int receiver;
};

/// What lying agents do to the numbers of a message. Stateless: the result depends on its arguments only.
class GARRISON_EXPORT MessageAttack {
 public:
  explicit MessageAttack(Schedule schedule) : schedule_(std::move(schedule)) {}
  virtual ~MessageAttack() = default;
  const Schedule& schedule() const { return schedule_; }
  /// Changes `values` in place for this receiver; false = the message is withheld.
  virtual bool rewrite(const Hop& hop, const Random& random, std::span<double> values) const = 0;

 private:
  Schedule schedule_;
};

/// Every neighbour gets values + offset (or `offset` alone when `replace`).
std::shared_ptr<MessageAttack> forge(Schedule schedule, double offset, bool replace);
/// Different lies to different neighbours: values + size * (a random direction per receiver and round).
std::shared_ptr<MessageAttack> equivocate(Schedule schedule, double size);
/// Nothing is sent.
std::shared_ptr<MessageAttack> silence(Schedule schedule);

}  // namespace garrison
