// SPDX-License-Identifier: Apache-2.0
#include "mpi/public_order.hpp"

#include <algorithm>

#include "mpi/here.hpp"

namespace garrison::mpi {
namespace {

/// First public id of the range of a rank.
int start_of(std::int64_t rank, std::int64_t ranks, int agents) {
  const std::int64_t blocks = (agents + std::int64_t{kBlock} - 1) / kBlock;
  return static_cast<int>(std::min<std::int64_t>(agents, blocks * rank / ranks * kBlock));
}

}  // namespace

PublicOrder::PublicOrder(std::span<const int> ids, int agents, int width) : width_(width) {
  const int rank = this_rank();
  const int ranks = all_ranks();
  first_ = start_of(rank, ranks, agents);
  last_ = start_of(rank + 1, ranks, agents);
  // Ids ascend, and so do the ranges: what a rank gets lies together as it is.
  for (int r = 0; r < ranks; ++r) {
    const auto begin = std::lower_bound(ids.begin(), ids.end(), start_of(r, ranks, agents));
    const auto end = std::lower_bound(begin, ids.end(), start_of(r + 1, ranks, agents));
    send_counts_.push_back(static_cast<int>(end - begin));
  }
  send_at_ = starts_of(send_counts_);
  receive_counts_.resize(send_counts_.size());
  MPI_Alltoall(send_counts_.data(), 1, MPI_INT, receive_counts_.data(), 1, MPI_INT, MPI_COMM_WORLD);
  receive_at_ = starts_of(receive_counts_);
  ids_.resize(static_cast<std::size_t>(last_ - first_));
  MPI_Alltoallv(ids.data(), send_counts_.data(), send_at_.data(), MPI_INT, ids_.data(),
                receive_counts_.data(), receive_at_.data(), MPI_INT, MPI_COMM_WORLD);
  MPI_Type_contiguous(width, MPI_DOUBLE, &record_);
  MPI_Type_commit(&record_);
}

PublicOrder::~PublicOrder() { MPI_Type_free(&record_); }

std::span<const double> PublicOrder::move(const double* own) {
  const auto width = static_cast<std::size_t>(width_);
  received_.resize(ids_.size() * width);
  range_.resize(received_.size());
  MPI_Alltoallv(own, send_counts_.data(), send_at_.data(), record_, received_.data(), receive_counts_.data(),
                receive_at_.data(), record_, MPI_COMM_WORLD);
  for (std::size_t k = 0; k < ids_.size(); ++k)
    std::copy_n(received_.data() + k * width, width,
                range_.data() + static_cast<std::size_t>(ids_[k] - first_) * width);
  return range_;
}

}  // namespace garrison::mpi
