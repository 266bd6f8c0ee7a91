// SPDX-License-Identifier: Apache-2.0
// Results by public id, whatever the partition: files and sums then have the same bits on any number of
// ranks.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <span>
#include <vector>

namespace garrison::mpi {

/// Agents whose numbers are summed in one go; the sums of blocks are added in order.
inline constexpr int kBlock = 4096;

/// Moves numbers of own agents to ranks that have ranges of public ids, multiples of kBlock agents each.
/// All ranks call everything. Threads: one at a time.
class PublicOrder {
 public:
  /// `ids`: own agents, ascending; of `agents` agents. `width`: numbers of each.
  PublicOrder(std::span<const int> ids, int agents, int width);
  PublicOrder(const PublicOrder&) = delete;
  PublicOrder& operator=(const PublicOrder&) = delete;
  ~PublicOrder();

  /// Public ids first..last-1 are this rank's range; it may be empty.
  int first() const { return first_; }
  int last() const { return last_; }
  /// `own`: width numbers per own agent. Returns width numbers per agent of the range.
  std::span<const double> move(const double* own);

 private:
  int width_;
  int first_ = 0;
  int last_ = 0;
  std::vector<int> send_counts_, send_at_, receive_counts_, receive_at_;
  std::vector<int> ids_;  // of what is received, in that order
  std::vector<double> received_;
  std::vector<double> range_;
  MPI_Datatype record_ = MPI_DATATYPE_NULL;
};

}  // namespace garrison::mpi
