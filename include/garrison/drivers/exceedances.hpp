// SPDX-License-Identifier: Apache-2.0
// How often tests say "too large": what a run tells about the false alarms it was designed for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/error.hpp"

namespace garrison {

/// Per agent, over all samples of a run.
struct Exceedances {
  std::vector<std::int64_t> tests;  ///< samples with a test: neither statistic nor threshold is NaN
  std::vector<std::int64_t> above;  ///< of these, with statistic > threshold
};

/// `statistic` and `threshold`: as a Record holds them, the agents side by side.
GARRISON_EXPORT Exceedances exceedances(std::span<const double> statistic, std::span<const double> threshold,
                                        int agents);

}  // namespace garrison
