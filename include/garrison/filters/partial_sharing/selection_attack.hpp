// SPDX-License-Identifier: Apache-2.0
// Which entries the Byzantine agents should share when the attack begins: maximise s'Gs, G = U o Sigma
// (31)-(36).
#pragma once

#include <cstdint>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::partial_sharing {

/// s is a 0/1 vector of B blocks of m entries with at most l ones each; G: B m x B m, symmetric, positive
/// semidefinite. The relaxation (33) loses nothing: the maximum of a convex function sits in a vertex (note
/// 11).
struct GARRISON_EXPORT SelectionProblem {
  SelectionProblem(Matrix G, int blocks, int most);  ///< @throws InvalidInput on shapes, most outside 0..m

  double objective(const Vector& s) const;  ///< @throws InvalidInput when s does not have B m numbers
  /// Best block i with the others fixed: v'G_ii v + factor * sum over j != i of v'G_ij s_j. Ties: fewest
  /// ones, then lexicographic by index set.
  Vector best_block(int i, const Vector& s, double factor) const;

  Matrix G;
  int blocks, size, most;
};

struct GARRISON_EXPORT Ascent {
  Vector s;                       ///< after rounding
  std::vector<double> objective;  ///< before the first sweep and after each
  double rounded = 0.0;           ///< objective after rounding: the l largest entries of each block become 1
};

/// Algorithm 2: `sweeps` sweeps from `start`. `factor` 1 is (36) as printed, 2 the true dependence on a
/// block; `newest`: blocks see the newest of the others (Gauss-Seidel), else those of the previous sweep
/// (Jacobi, printed). Only factor 2 with `newest` is monotone. Rounding as printed forces exactly l ones;
/// skipped when `rounding` is false.
GARRISON_EXPORT Ascent ascent(const SelectionProblem& problem, const Vector& start, int sweeps, double factor,
                              bool newest, bool rounding = true);
/// Gauss-Seidel with factor 2 to its fixed point from `starts` random starts: the best s found.
GARRISON_EXPORT Vector best_of_starts(const SelectionProblem& problem, int starts, std::uint64_t seed);

struct GARRISON_EXPORT ExactSelection {
  Vector s;
  double objective = 0.0;
  bool exact = true;  ///< the search ended; else s is the best found and `upper` a bound
  double upper = 0.0;
  std::int64_t nodes = 0;
};
/// Global maximum by branch and bound over blocks.
GARRISON_EXPORT ExactSelection exact_selection(const SelectionProblem& problem,
                                               std::int64_t max_nodes = 5'000'000);

}  // namespace garrison::partial_sharing
