// SPDX-License-Identifier: Apache-2.0
// One run on all ranks.
#pragma once

#include <cstdint>
#include <string>

namespace garrison::mpi {

struct RunCommand {
  std::string program = "garrison-mpi";  ///< as it was called
  std::string scenario;
  std::string results;          ///< empty: none are written
  std::int64_t halo = 1;        ///< rounds per exchange, where a sample has as many
  std::int64_t checkpoint = 0;  ///< samples between checkpoints; 0 = none
  bool resume = false;
  bool force = false;  ///< replace results that are there
  bool hash = false;   ///< print the hash of all estimates
};

/// All ranks call it. @throws Error on all ranks with the same message
void run(const RunCommand& command);

}  // namespace garrison::mpi
