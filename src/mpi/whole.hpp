// SPDX-License-Identifier: Apache-2.0
// The same scenario with the engine of one process.
#pragma once

#include <string>

namespace garrison::mpi {

/// Prints the hash that all ranks of `run` together have to have; no communication. `threads`: 0 = all cores.
/// @throws Error as `read_scenario` and `simulate`
void run_whole(const std::string& scenario, int threads);

}  // namespace garrison::mpi
