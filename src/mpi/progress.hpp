// SPDX-License-Identifier: Apache-2.0
// How far a long job is: a line on standard error of rank 0 after two seconds, and then ever more rarely.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "mpi/here.hpp"

namespace garrison::mpi {

/// Threads: one at a time.
class Progress {
 public:
  /// `what` is counted, up to `all`.
  Progress(const char* what, std::int64_t all) : what_(what), all_(all), speaks_(this_rank() == 0) {}
  void at(std::int64_t count) {
    if (!speaks_) return;
    const double passed = MPI_Wtime() - start_;
    if (passed < next_) return;
    next_ = passed + std::min(60.0, passed);
    std::fprintf(stderr, "garrison-mpi: %s %" PRId64 " of %" PRId64 " after %.0f s\n", what_, count, all_,
                 passed);
  }

 private:
  const char* what_;
  std::int64_t all_;
  bool speaks_;
  double start_ = MPI_Wtime();
  double next_ = 2.0;
};

}  // namespace garrison::mpi
