// SPDX-License-Identifier: Apache-2.0
// Agents that lie: attacks on the messages they send.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "garrison/attacks/schedule.hpp"
#include "garrison/core/fields.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// One message on its way.
struct Hop {
  std::int64_t t;
  int round;
  int sender;
  int receiver;
  int states = 0;  ///< n of the plant
  std::span<const int> entries =
      {};                  ///< which state each number belongs to; empty = the first, the second, ..
  std::uint32_t salt = 0;  ///< keeps the chance of several attacks apart
};

/// What lying agents do to a message. Stateless: the result depends on its arguments only.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT MessageAttack {
 public:
  explicit MessageAttack(Schedule schedule) : schedule_(std::move(schedule)) {}
  virtual ~MessageAttack() = default;
  const Schedule& schedule() const { return schedule_; }
  /// Changes fields in place for this receiver; false = the message is withheld.
  virtual bool rewrite(const Hop& hop, const Random& random, const FieldList& message) const = 0;
  /// How many samples old what is sent as new is, before `rewrite`; 0 = new.
  virtual int age() const { return 0; }
  /// Its numbers fit a plant with that many states; drivers refuse an attack that does not.
  virtual bool fits(int) const { return true; }
  /// Refuses a family whose messages do not have what the attack lies about, in a network of `agents`.
  /// @throws InvalidInput
  virtual void require(const FieldList&, int /*agents*/) const {}

 private:
  Schedule schedule_;
};

/// Every neighbour gets each number + offset (or `offset` alone when `replace`).
GARRISON_EXPORT std::shared_ptr<MessageAttack> forge(Schedule schedule, double offset, bool replace);
/// Different lies to different neighbours: values + size * (a random direction per receiver and round).
GARRISON_EXPORT std::shared_ptr<MessageAttack> equivocate(Schedule schedule, double size);
/// Every neighbour gets values + delta(t) with delta ~ N(0, covariance), drawn once per sample for all liars
/// together and new at every sample. `covariance`: B n x B n for the B agents of the schedule in ascending
/// order; may be singular. Agents send as many of their entries as their filter shares.
/// @throws InvalidInput when it is not symmetric positive semidefinite, or its size is no multiple of B
GARRISON_EXPORT std::shared_ptr<MessageAttack> coordinated(Schedule schedule, const Matrix& covariance);
/// Every neighbour gets values + delta(t) with given delta: `deltas` has one row per sample from the start of
/// the schedule on (zero afterwards) and B n columns, agents in ascending order.
GARRISON_EXPORT std::shared_ptr<MessageAttack> perturb(Schedule schedule, const Matrix& deltas);
/// A lie in one field, whatever it is: numbers, a count and an optional number become `value`, a flag whether
/// it is not 0, a set just the agents `members`. A value that no honest agent could send is refused by the
/// receivers.
GARRISON_EXPORT std::shared_ptr<MessageAttack> falsify(Schedule schedule, std::string field, double value,
                                                       std::vector<int> members);
/// What was sent `age` >= 1 samples ago is sent again, as new.
GARRISON_EXPORT std::shared_ptr<MessageAttack> outdated(Schedule schedule, int age);
/// Nothing is sent.
GARRISON_EXPORT std::shared_ptr<MessageAttack> silence(Schedule schedule);

}  // namespace garrison
