// SPDX-License-Identifier: Apache-2.0
// Partitions: METIS where it is linked, coordinates or blocks of ids otherwise; kept beside the scenario.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mpi/scenario.hpp"

namespace garrison::mpi {

/// Agents up to which one rank cuts the whole network with METIS.
inline constexpr int kMostForMetis = 10'000'000;

/// A rank per agent.
struct Owners {
  std::vector<std::int32_t> of;
  std::string made;           ///< how, for people
  std::string not_kept = {};  ///< why the cache could not be written; empty: it was
};

/// From the cache, or made and cached; no communication. @throws InvalidInput when ranks > agents, or the
/// partition that was asked for is not to be had or leaves ranks without work
Owners owners_of(const Scenario& scenario, int ranks);
/// Where the cache is.
std::string cache_of(const Scenario& scenario, int ranks);

/// METIS' k-way partition with the least volume between parts; empty where METIS fails or is not linked.
std::vector<std::int32_t> metis_owners(const partition::Ground& ground, int ranks);
bool has_metis();

}  // namespace garrison::mpi
