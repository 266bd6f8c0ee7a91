// SPDX-License-Identifier: Apache-2.0
// The result file: netCDF in its classic form (64-bit offsets), written by all ranks.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "mpi/public_order.hpp"
#include "mpi/scenario.hpp"
#include "mpi/summary.hpp"

namespace garrison::mpi {

/// Dimensions time (unlimited), state, and agent where estimates are kept; agents are in order of public ids.
/// The bytes do not depend on the number of ranks. All ranks call everything; what fails on one of them is
/// thrown on all. Threads: one at a time.
class Results {
 public:
  /// Makes a new file, or opens the one that this scenario wrote before. @throws InvalidInput
  Results(const std::string& path, const Scenario& scenario, bool resume);
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;
  ~Results();

  /// `estimates`: of the range of `order`; `summary` counts on rank 0.
  void write(std::int64_t t, std::span<const double> truth, const Summary& summary, const PublicOrder& order,
             std::span<const double> estimates);
  /// Refuses a file that does not hold all samples up to `t`. @throws InvalidInput
  void require_until(std::int64_t t);
  /// What was written so far is on the disk, and the file is whole.
  void sync();

 private:
  void create(const Scenario& scenario);
  void open(const Scenario& scenario);
  void make_room(std::uintmax_t from, std::uintmax_t to);
  /// Bytes of the file with so many records.
  std::uintmax_t length_of(MPI_Offset records);
  /// Keeps the first failure of this rank for `agree`.
  void check(int code, const char* what, const char* advice = "use another -o, or free the disk");
  void settle();

  std::string path_;
  std::string failure_;
  int file_ = -1;
  int time_ = -1, truth_ = -1, mean_ = -1, largest_ = -1, median_ = -1, q95_ = -1, estimate_ = -1;
  int every_;
  bool estimates_;
};

}  // namespace garrison::mpi
