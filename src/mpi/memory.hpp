// SPDX-License-Identifier: Apache-2.0
// Memory: what this process took, and what a network takes at least.
#pragma once

namespace garrison::mpi {

/// Bytes that a network takes on this machine.
struct Bytes {
  double agent;  ///< per agent
  double heard;  ///< per agent that an agent hears
};

/// Held by one process as a whole, with its design.
inline constexpr Bytes kWhole{1500.0, 4.0};
/// Only cut into parts.
inline constexpr Bytes kPartition{12.0, 0.0};

/// The most that this process has taken so far, in units of 2^20 bytes.
double megabytes();

/// Processes of the job on this machine. All ranks call it.
int ranks_here();

/// What the ranks on this machine take at least, all together: a list of all agents each, and `own` bytes for
/// each of their own and 4 for each that these hear. All ranks call it.
Bytes shared_bytes(double own);

}  // namespace garrison::mpi
