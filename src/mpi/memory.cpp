// SPDX-License-Identifier: Apache-2.0
#include "mpi/memory.hpp"

#include <mpi.h>
#include <sys/resource.h>

#include "mpi/here.hpp"

namespace garrison::mpi {

double megabytes() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_maxrss) / 1024.0;
}

int ranks_here() {
  MPI_Comm here = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  int ranks = 1;
  MPI_Comm_size(here, &ranks);
  MPI_Comm_free(&here);
  return ranks;
}

Bytes shared_bytes(double own) {
  constexpr double kListed = 5.0;  // whose it is, whether it is known
  const double here = ranks_here();
  const double share = here / all_ranks();
  return {here * kListed + share * own, share * 4.0};
}

}  // namespace garrison::mpi
