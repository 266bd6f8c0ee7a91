// SPDX-License-Identifier: Apache-2.0
// The families that run on many ranks, by name.
#pragma once

#include <memory>
#include <string>

#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/params.hpp"
#include "partition/part_runner.hpp"

namespace garrison::partition {

/// Refuses a family that does not run on many ranks, with those that do; `which` names its place.
/// @throws InvalidInput
void require_family(const std::string& family, const std::string& which);

/// Refuses parameters that the design refuses whatever the network: `one` is the model of any agent.
/// @throws InvalidInput as `require_family`, and as the family's design does
void require_params(const std::string& family, const ParamMap& params, const Model& one);

/// Agents up to which a family whose agents' gains depend on each other is designed as a whole: its design
/// then has more ways to a solution.
inline constexpr int kDesignedWhole = 20000;

/// Why the design of this filter needs the whole model and network; empty where ranks design their own
/// agents.
/// @throws InvalidInput as `require_family`, and for parameters that do not fit
std::string needs_whole(const std::string& family, const ParamMap& params, int agents);

/// Exchanges of messages that a sample needs, one after the other. @throws InvalidInput as `needs_whole`
int rounds_of(const std::string& family, const ParamMap& params);

/// Whether the family's design refuses a network that is not connected (partition/connected.hpp).
bool needs_connected(const std::string& family);

/// Everything that a design may need.
struct Whole {
  Model model;
  Network network;
};

/// The agents of a rank; all ranks together. `whole`: null unless `needs_whole`; `own`: the model of the own
/// agents in ascending order of public ids. `region` and `exchange` must outlive the runner.
/// @throws InvalidInput as the family's design does, on all ranks alike where `whole` is null
std::unique_ptr<PartRunner> part_runner(const std::string& family, const ParamMap& params, const Whole* whole,
                                        const Model& own, const Region& region, Exchange& exchange);

}  // namespace garrison::partition
