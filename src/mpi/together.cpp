// SPDX-License-Identifier: Apache-2.0
#include "mpi/together.hpp"

#include "mpi/here.hpp"

namespace garrison::mpi {

void agree(const std::string& failure) {
  const int rank = this_rank();
  const int ranks = all_ranks();
  int first = failure.empty() ? ranks : rank;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == ranks) return;
  auto size = static_cast<int>(failure.size());
  MPI_Bcast(&size, 1, MPI_INT, first, MPI_COMM_WORLD);
  std::string message = failure;
  message.resize(static_cast<std::size_t>(size));
  MPI_Bcast(message.data(), size, MPI_CHAR, first, MPI_COMM_WORLD);
  throw InvalidInput(message);
}

}  // namespace garrison::mpi
