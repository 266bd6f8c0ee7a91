// SPDX-License-Identifier: Apache-2.0
// The design of a part of a network that nobody holds as a whole.
#pragma once

#include "garrison/filters/rdkf/filter.hpp"
#include "garrison/filters/rdkf/steady_state.hpp"

namespace garrison::rdkf {

/// `model`, `network`: the agents of the part, and those of others that they hear, without rows; numbered in
/// the order of the whole. Gains of the part's own agents, and J of the others, have the bits of
/// `Rdkf::design` for the whole network; what else the others have is of no use.
/// @throws InvalidInput as that does, on all parts alike; and where the sweeps of (5) do not settle
Rdkf::Gains design_part(const Rdkf::Params& params, const Model& model, const Network& network,
                        Borders& borders);
/// The same for the unprotected filter.
Rdkf::Gains design_part(const Dkf::Params& params, const Model& model, const Network& network,
                        Borders& borders);

}  // namespace garrison::rdkf
