// SPDX-License-Identifier: Apache-2.0
// The spectrum of a scenario's network, and the step that averages best with it.
#pragma once

#include <cstdint>
#include <string>

namespace garrison::mpi {

struct SpectrumCommand {
  std::string scenario;
  std::int64_t products = 5000;  ///< at most
  bool slepc = false;            ///< SLEPc in place of Lanczos
};

/// Rank 0 prints. All ranks call it. False where the search ended before it settled.
/// @throws Error on all ranks with the same message
bool print_spectrum(const SpectrumCommand& command);

}  // namespace garrison::mpi
