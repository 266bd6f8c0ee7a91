// SPDX-License-Identifier: Apache-2.0
// Where a run writes, asked for before hours are spent; and how it is gone on with.
#pragma once

#include <string>

#include "mpi/run.hpp"
#include "mpi/scenario.hpp"

namespace garrison::mpi {

/// Refuses results that cannot be written, would take the place of something else, or are not there to be
/// gone on with, and checkpoints that would never be written; no communication. @throws InvalidInput
void require_outputs(const RunCommand& command, const Scenario& scenario);

/// What a shell takes for the command that goes on from the last checkpoint.
std::string resume_command(const RunCommand& command, int ranks);

}  // namespace garrison::mpi
