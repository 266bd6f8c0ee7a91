// SPDX-License-Identifier: Apache-2.0
// The resilient Kalman filter's design by all ranks together, each with its own agents.
#pragma once

#include "garrison/filters/rdkf/part_design.hpp"
#include "partition/cast.hpp"

namespace garrison::partition {

/// Gains by name (`Cast`) for the agents of `own`, and J of the ghosts. All ranks together.
/// @throws InvalidInput on all ranks alike
template <class Params>
Rdkf::Gains rdkf_here(const Params& params, const Model& own, const Region& region, Exchange& exchange);

}  // namespace garrison::partition
