// SPDX-License-Identifier: Apache-2.0
// The network in parts: who has which agents, and what this rank sees of its own.
#pragma once

#include <string>
#include <vector>

#include "mpi/mpi_exchange.hpp"
#include "mpi/scenario.hpp"
#include "partition/region.hpp"

namespace garrison::mpi {

struct Cut {
  std::vector<int> ids;  ///< public ids of this rank's agents, ascending
  partition::Region region;
  std::string made;  ///< how, for people; on rank 0
};

/// Decided on one rank, for all; ghosts up to `depth` hops away. All ranks together. @throws InvalidInput
Cut cut_of(const Scenario& scenario, MpiExchange& exchange, int depth);

/// Rank 0 prints what became of it. All ranks together.
void say_cut(const partition::Region& region, MpiExchange& exchange, const std::string& made);

}  // namespace garrison::mpi
