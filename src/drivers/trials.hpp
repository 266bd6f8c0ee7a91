// SPDX-License-Identifier: Apache-2.0
// The trials of a run, on threads: one by one, or side by side where the family can.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "garrison/drivers/simulate.hpp"
#include "plant.hpp"

namespace garrison::detail {

/// Of the run's trial 0, 1, ..
using MakeSource = std::function<std::unique_ptr<Source>(std::uint32_t trial)>;

/// The number under which a trial of this run draws its random numbers.
inline std::uint32_t drawn_as(const RunOptions& options, std::uint32_t trial) {
  return static_cast<std::uint32_t>(options.first_trial) + trial;
}

/// Initial estimates, n x N, of `RunOptions::start`. @throws InvalidInput when it does not fit
Matrix starts(const Model& model, const Matrix& given);

/// @throws InvalidInput when the options fit neither the plant nor the network
Record run_trials(const Prepared& prepared, int steps, bool truth_known, const RunOptions& options,
                  const MakeSource& make);

}  // namespace garrison::detail
