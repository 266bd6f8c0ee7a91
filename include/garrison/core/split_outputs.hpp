// SPDX-License-Identifier: Apache-2.0
// Sensors with several outputs as several scalar sensors (saturation paper, section II-B).
#pragma once

#include <vector>

#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"

namespace garrison {

/// Agents with at most one output each, and whom they belong to.
struct GARRISON_EXPORT SplitSystem {
  Model model;
  Network network;
  std::vector<int> owner;  ///< of each new agent: id of the old one; ascending
};

/// Replaces every agent with m > 1 outputs by m scalar agents that hear each other and all neighbours of the
/// original. Measurements keep their flat order. One attacked original counts as m attacked agents. Diagonals
/// of measurement covariances are kept, cross terms are dropped.
GARRISON_EXPORT SplitSystem split_outputs(const Model& model, const Network& network);

}  // namespace garrison
