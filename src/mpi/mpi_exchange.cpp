// SPDX-License-Identifier: Apache-2.0
#include "mpi/mpi_exchange.hpp"

#include "mpi/here.hpp"

namespace garrison::mpi {

MpiExchange::~MpiExchange() {
  if (record_ != MPI_DATATYPE_NULL) MPI_Type_free(&record_);
  if (neighbours_ != MPI_COMM_NULL) MPI_Comm_free(&neighbours_);
}

int MpiExchange::rank() const { return this_rank(); }
int MpiExchange::ranks() const { return all_ranks(); }

void MpiExchange::connect(const partition::Routes& routes) {
  if (neighbours_ != MPI_COMM_NULL) return;
  routes_ = routes;
  send_at_ = starts_of(routes.sends);
  receive_at_ = starts_of(routes.receives);
  const auto peers = static_cast<int>(routes.peers.size());
  MPI_Dist_graph_create_adjacent(MPI_COMM_WORLD, peers, routes.peers.data(), MPI_UNWEIGHTED, peers,
                                 routes.peers.data(), MPI_UNWEIGHTED, MPI_INFO_NULL, 0, &neighbours_);
}

void MpiExchange::records_of(std::size_t bytes) {
  if (bytes == record_bytes_) return;
  if (record_ != MPI_DATATYPE_NULL) MPI_Type_free(&record_);
  MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &record_);
  MPI_Type_commit(&record_);
  record_bytes_ = bytes;
}

void MpiExchange::begin(const std::byte* out, std::byte* in, std::size_t bytes) {
  if (routes_.peers.empty() || bytes == 0) return;
  records_of(bytes);
  MPI_Ineighbor_alltoallv(out, routes_.sends.data(), send_at_.data(), record_, in, routes_.receives.data(),
                          receive_at_.data(), record_, neighbours_, &request_);
}

void MpiExchange::finish() {
  if (request_ == MPI_REQUEST_NULL) return;
  const double start = MPI_Wtime();
  MPI_Wait(&request_, MPI_STATUS_IGNORE);
  waited_ += MPI_Wtime() - start;
}

void MpiExchange::sum(std::span<std::int64_t> values) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM,
                MPI_COMM_WORLD);
}
void MpiExchange::largest(std::span<double> values) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX,
                MPI_COMM_WORLD);
}

}  // namespace garrison::mpi
