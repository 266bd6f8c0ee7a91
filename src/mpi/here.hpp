// SPDX-License-Identifier: Apache-2.0
// This process among all, and where in an array what each of them sends or gets begins.
#pragma once

#include <mpi.h>

#include <numeric>
#include <vector>

namespace garrison::mpi {

inline int this_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}
inline int all_ranks() {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}
/// First place of each rank's records, which lie one behind the other, from how many each has.
inline std::vector<int> starts_of(const std::vector<int>& counts) {
  std::vector<int> starts(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  return starts;
}

}  // namespace garrison::mpi
