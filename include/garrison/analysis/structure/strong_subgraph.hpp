// SPDX-License-Identifier: Apache-2.0
// The cheapest network in which everybody can reach everybody (Remark 9 of the structural paper).
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "garrison/analysis/structure/pattern.hpp"

namespace garrison::structure {

struct GARRISON_EXPORT StrongSubgraph {
  bool exists = false;
  std::vector<int> edges;          ///< indices into the given edges, sorted
  double cost = kInfinity;         ///< of these edges
  double lower_bound = kInfinity;  ///< no strongly connected choice is cheaper
  bool exact = false;              ///< the search finished: cost = lower_bound
};

/// Least total weight of a strongly connected spanning subgraph. The problem is NP-hard in general
/// (docs/filters/structural.md#d28): branch and bound over `max_nodes` choices, started from the union of a
/// cheapest out- and a cheapest in-arborescence of the best root (at most twice the optimum). `edges`: (from,
/// to) pairs, `weights` >= 0.
/// @throws InvalidInput when an edge leaves 0..agents-1 or a weight is negative or not finite.
GARRISON_EXPORT StrongSubgraph cheapest_strong_subgraph(int agents,
                                                        std::span<const std::pair<int, int>> edges,
                                                        std::span<const double> weights,
                                                        long long max_nodes = 2'000'000);

/// Edges of a cheapest spanning arborescence out of `root` (Chu-Liu/Edmonds); empty when some vertex cannot
/// be reached (or there is one vertex only).
std::vector<int> cheapest_arborescence(int agents, std::span<const std::pair<int, int>> edges,
                                       std::span<const double> weights, int root);

}  // namespace garrison::structure
