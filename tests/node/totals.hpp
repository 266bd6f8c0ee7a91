// SPDX-License-Identifier: Apache-2.0
// What simulated runs have shown.
#pragma once

#include <cstdint>

namespace garrison::node::test {

/// What a run has shown; every `*_wrong` must be 0.
struct Totals {
  std::int64_t seeds = 0, events = 0, datagrams = 0, samples = 0, complete = 0, missing = 0, wants = 0,
               resent = 0;
  std::int64_t injected = 0, mutated = 0, refused = 0, conflicts = 0, crashes = 0, joins = 0, clock_steps = 0;
  std::int64_t taken_twice_wrong = 0;  ///< a datagram accepted a second time
  std::int64_t mutants_wrong = 0;      ///< a changed one accepted
  std::int64_t fused = 0,
               fused_wrong = 0;  ///< bodies that their sender did not produce for that sample and round
  std::int64_t bodies = 0, bodies_wrong = 0;          ///< samples and rounds with two bodies of one node
  std::int64_t estimates = 0, estimates_wrong = 0;    ///< not finite
  std::int64_t bounds = 0, bounds_wrong = 0;          ///< errors beyond a reported bound
  std::int64_t proofs = 0, proofs_wrong = 0;          ///< node-samples that hold an honest sensor for proved
  std::int64_t nodes = 0, nodes_wrong = 0;            ///< not back with all links at the end
  std::int64_t convictions = 0;                       ///< of liars who signed two things, by one node each
  std::int64_t statements = 0, statements_wrong = 0;  ///< of honest nodes that seemed to contradict something
  std::int64_t replayed = 0, replayed_wrong = 0;
  std::int64_t plain = 0, plain_wrong = 0;  ///< compared with the agents driven by a plain loop
  std::int64_t steps = 0,
               steps_wrong = 0;  ///< of clocks that became right, and no complete sample came of it
  std::int64_t equivocations = 0,
               equivocations_wrong = 0;  ///< not proved by two nodes within three batches

  std::int64_t wrong() const {
    return taken_twice_wrong + mutants_wrong + fused_wrong + bodies_wrong + estimates_wrong + bounds_wrong +
           proofs_wrong + statements_wrong + nodes_wrong + replayed_wrong + plain_wrong + steps_wrong +
           equivocations_wrong;
  }
};

}  // namespace garrison::node::test
