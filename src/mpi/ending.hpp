// SPDX-License-Identifier: Apache-2.0
// What is said when a rank has died and the job is ended.
#pragma once

#include <cstdint>
#include <string>

namespace garrison::mpi {

/// mpirun ends the other ranks by a signal; the first of them says `line` on standard error, once (the file
/// `flag` tells the others). Threads: one at a time.
void say_when_ended(const std::string& line, const std::string& flag);

}  // namespace garrison::mpi
