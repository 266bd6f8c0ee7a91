// SPDX-License-Identifier: Apache-2.0
// The red team: the worst covariance of given energy (37), and what it does to the network.
#pragma once

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
  Matrix covariance;  ///< energy v v', an optimum (note 12); B m x B m
};

/// (37): the worst Sigma for the next step alone, when S(k) is about to be used: form = Ga(k)'Ga(k) on the
/// Byzantine agents. No semidefinite program: the optimum is one eigenvector. @throws InvalidInput on a bad
/// energy or agent
GARRISON_EXPORT WorstCovariance worst_one_step(const Setting& setting, const std::vector<LocalGains>& gains,
                                               std::vector<int> byzantine, double energy, std::int64_t k);
/// The worst Sigma for the NMSE in periodic steady state: form N = mean over phases of Ga(f)' W(f+1) Ga(f)
/// from one adjoint solve (note 13); tr(Sigma N) is exactly what any Sigma adds to the cycle-averaged NMSE.
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

}  // namespace garrison::partial_sharing
