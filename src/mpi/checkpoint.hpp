// SPDX-License-Identifier: Apache-2.0
// States of all agents at one sample, in a file per rank; read by any number of ranks.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "partition/part_runner.hpp"

namespace garrison::mpi {

/// `<results>.checkpoint`
std::string checkpoint_folder(const std::string& results);

/// This folder with one complete set of files. `latest` says which one counts; it is
/// replaced once all files of the next set are on the disk.
class Checkpoint {
 public:
  Checkpoint(const std::string& results, std::uint64_t scenario);

  /// Forgets what an earlier run left; no communication. @throws IoError
  void clear() const;
  /// Makes the folder; no communication. @throws IoError
  void make() const;
  /// All ranks: writes the own agents `ids` after sample `t`. @throws IoError on all ranks
  void write(std::int64_t t, const std::vector<int>& ids, const partition::PartRunner& runner) const;
  /// The sample that can be gone on from; no communication. @throws IoError when there is none, InvalidInput
  /// when it is of another scenario
  std::int64_t sample() const;
  /// Reads the own agents `ids` of that sample; no communication. @throws IoError, InvalidInput
  void read(const std::vector<int>& ids, partition::PartRunner& runner) const;

 private:
  struct Latest {
    std::int64_t sample;
    int ranks;
  };
  Latest latest() const;
  std::string file_of(std::int64_t t, int rank, int ranks) const;

  std::string folder_;
  std::uint64_t scenario_;
};

}  // namespace garrison::mpi
