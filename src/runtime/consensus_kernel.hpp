// SPDX-License-Identifier: Apache-2.0
// The inner loop of consensus rounds. Raw pointers only: it is compiled for several instruction sets.
#pragma once

#include <cstdint>

namespace garrison::kernel {

/// One round for the rows begin..end-1 of N x width arrays.
struct RowJob {
  const std::int32_t* first;  ///< N+1 offsets into `neighbour`
  const std::int32_t* neighbour;
  const double* now;
  double* next;  ///< holds the values of one round ago when omega != 1
  std::int32_t begin;
  std::int32_t end;
  double alpha;
  double omega;
};

/// Same bits as average_round on every instruction set: all operations are entry by entry, uncontracted.
void average_rows(const RowJob& job, int width);

}  // namespace garrison::kernel
