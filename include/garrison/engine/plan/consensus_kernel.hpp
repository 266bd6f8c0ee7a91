// SPDX-License-Identifier: Apache-2.0
// The inner loop of consensus rounds. Raw pointers only: it is compiled for several instruction sets.
#pragma once

#include <cstdint>

namespace garrison::kernel {

/// Consecutive rows of the same degree.
struct Run {
  std::int32_t begin;  ///< rows
  std::int32_t end;
  std::int32_t degree;
  std::int32_t edge;  ///< where the neighbours of row `begin` start; those of the next rows follow
};

/// One round of N x width arrays.
struct Round {
  const std::int32_t* neighbour;  ///< where the rows of neighbours start in `now`
  const double* now;
  double* next;  ///< holds the values of one round ago when omega != 1
  double alpha;
  double omega;
};

/// The rows of runs first..last-1. Same bits as average_round on every instruction set: all operations are
/// entry by entry, uncontracted.
void average_runs(const Round& round, const Run* first, const Run* last, int width);

}  // namespace garrison::kernel
