// SPDX-License-Identifier: Apache-2.0
// One trial on one rank: plant, attacks, links and the agents of this rank, sample by sample, with the bits
// that `simulate` has for the whole network.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "garrison/drivers/simulate.hpp"
#include "partition/part_runner.hpp"

namespace garrison::partition {

/// Refuses at once what `PartRun` would refuse after the design: attacks and noise that cannot be simulated.
/// `some`: the model of the agents `ids`, any ones. @throws InvalidInput
void require_simulable(const Model& some, std::vector<int> ids, const PlantOptions& plant,
                       const RunOptions& options);

/// The truth is worked out on every rank: it is as small as the plant.
/// Threads: one at a time.
class PartRun {
 public:
  /// `model`: of the own agents; `ids`: theirs in the whole network of `agents` agents, ascending. `options`:
  /// no inputs, no series, no certificate, trial `first_trial`; `options.start` is one estimate for all.
  /// @throws InvalidInput when something does not fit
  PartRun(PartRunner& runner, const Model& model, std::vector<int> ids, int agents, PlantOptions plant,
          RunOptions options);
  ~PartRun();

  /// Time 0: every agent starts. All ranks together, as everything below.
  void start();
  /// Moves on to the next sample.
  void advance();
  /// Goes to the end of sample `t`, whose states the runner is then given: truth and attacks are worked out
  /// again from the start, agents do nothing. @throws InvalidInput where lies need messages of the past
  void skip_to(std::int64_t t);

  std::int64_t sample() const { return t_; }
  /// n numbers.
  std::span<const double> truth() const;
  /// Of the messages that own agents should have received.
  const LinkCounters& link() const;

 private:
  struct Parts;
  void measure();

  PartRunner& runner_;
  PlantOptions plant_;
  RunOptions options_;
  std::int64_t t_ = 0;
  std::unique_ptr<Parts> parts_;
};

}  // namespace garrison::partition
