// SPDX-License-Identifier: Apache-2.0
// The red team: the worst covariance of given energy (37), and what it does to the network.
#pragma once

#include <cstdint>
#include <vector>

#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::partial_sharing {

/// A quadratic cost of the perturbations: tr(Sigma form), Sigma on the Byzantine agents in ascending order.
struct GARRISON_EXPORT WorstCovariance {
  std::vector<int> byzantine;  ///< sorted
  Matrix form;                 ///< B m x B m, symmetric positive semidefinite
  Vector direction;  ///< unit top eigenvector, its largest entry positive; zero when nothing can be gained
  double gain =
      0.0;  ///< energy times the top eigenvalue: the largest tr(Sigma form) with tr(Sigma) <= energy
  Matrix covariance;  ///< energy v v', an optimum (docs/filters/partial_sharing.md#m12); B m x B m
};

/// (37): the worst Sigma for the next step alone, when S(k) is about to be used: form = Ga(k)'Ga(k) on the
/// Byzantine agents. No semidefinite program: the optimum is one eigenvector. @throws InvalidInput on a bad
/// energy or agent
GARRISON_EXPORT WorstCovariance worst_one_step(const Setting& setting, const std::vector<LocalGains>& gains,
                                               std::vector<int> byzantine, double energy, std::int64_t k);
/// The worst Sigma for the NMSE in periodic steady state: form N = mean over phases of Ga(f)' W(f+1) Ga(f)
/// from one adjoint solve (docs/filters/partial_sharing.md#m13); tr(Sigma N) is exactly what any Sigma adds
/// to the cycle-averaged NMSE.
/// @throws InvalidInput also when the error dynamics are unstable
GARRISON_EXPORT WorstCovariance worst_steady(const Setting& setting, const std::vector<LocalGains>& gains,
                                             std::vector<int> byzantine, double energy);
/// N of worst_steady for any Byzantine agents, N m x N m: rows and columns of all agents.
GARRISON_EXPORT Matrix steady_attack_matrix(const Setting& setting, const std::vector<LocalGains>& gains);
/// A covariance of the Byzantine agents as one of the network (zero elsewhere).
GARRISON_EXPORT Matrix spread_covariance(const Setting& setting, const std::vector<int>& byzantine,
                                         const Matrix& block);
/// The `count` agents that most others hear from, ties to the lower id, sorted. The worst-placed liars.
GARRISON_EXPORT std::vector<int> top_degree(const Setting& setting, int count);

/// U of (31), block (i,j) = sum of C_q'C_q over agents q that hear both i and j. B m x B m.
GARRISON_EXPORT Matrix coupling_form(const Setting& setting, const std::vector<LocalGains>& gains,
                                     const std::vector<int>& byzantine);

// Which entries the Byzantine agents should share when the attack begins: maximise s'Gs, G = U o Sigma
// (31)-(36).

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
