// SPDX-License-Identifier: Apache-2.0
// Consensus rounds of a whole network at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/engine/plan/consensus_kernel.hpp"
#include "garrison/engine/workers.hpp"

namespace garrison {

/// L rounds of x_i <- x_i - alpha sum over j in N_i of (x_i - x_j) for all agents, with the same bits as
/// `average_round` agent by agent.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT ConsensusPlan {
 public:
  /// Lists of a network in public ids, each sorted: `offsets` N+1 numbers into `lists`. `width` >= 1: numbers
  /// per agent. @throws InvalidInput when N x width numbers are too many for 32-bit indices
  ConsensusPlan(std::span<const int> offsets, std::span<const int> lists, int width);

  /// Position -> public id: the order in which `run` expects the rows.
  std::span<const int> order() const { return order_; }

  /// In place on x, N x width row by row in `order()`; scratch has the same size. `omega`: Chebyshev weight
  /// per round, empty = plain. Does not allocate. With `workers` each round is split over
  /// threads, otherwise several rounds are fused where the rows do not fit into the cache; the bits are the
  /// same.
  void run(double* x, double* scratch, double alpha, std::span<const double> omega, int rounds,
           Workers* workers = nullptr) const;

 private:
  int rounds_in_flight() const;

  int width_;
  std::vector<int> order_;
  std::vector<std::int32_t> neighbour_;  // width times their positions, each row in order of public ids
  std::vector<kernel::Run> runs_;
  std::vector<std::int32_t> windows_;  // first run of each window of rows, and the end
  std::int32_t reach_ = 1;             // windows that a row and its neighbours are apart at most
};

}  // namespace garrison
