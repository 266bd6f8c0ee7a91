// SPDX-License-Identifier: Apache-2.0
// The full solution (4)-(7): every agent would need its neighbours' cross-covariances. For comparison only.
#pragma once

#include <vector>

#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::partial_sharing {

struct GARRISON_EXPORT FullSolution {
  std::vector<Matrix> estimate;  ///< [k = 0..steps], N x m: predictions xhat_i(k)
  std::vector<double> trace;     ///< tr P(k), k = 0..steps
  std::vector<Matrix> K, C;      ///< gains of the last step, per agent
  Matrix P;                      ///< P(steps), N m x N m
};

/// (4)-(7) with K_i* as printed after (7) and C_i = gamma (A - K H_i) P_ii from its own block. Knows the
/// whole network, so it is no agent. K_i* minimises the next step's trace only: over time it is not always
/// better than Algorithm 1 (note 16), and agents do not know an attack, so Sigma never enters the gains.
/// `start`: N x m. `y`: per step the stacked measurements, steps x (sum of n_i); no rows: only covariances,
/// for `steps` steps. `delta`: per step the stacked perturbations, steps x N m, or no rows.
/// @throws InvalidInput when a shape does not fit
GARRISON_EXPORT FullSolution full_solution(const Setting& setting, int steps, const MatrixRef& start,
                                           const MatrixRef& y, const MatrixRef& delta, const Matrix& Sigma,
                                           std::int64_t k0, bool common);

}  // namespace garrison::partial_sharing
