// SPDX-License-Identifier: Apache-2.0
// The estimation error of the structural filter: its recursion (5), stationary covariance and residuals.
#pragma once

#include "garrison/filters/structural/setting.hpp"

namespace garrison::structural {

/// e(k+1) = Ahat e(k) + ..., stacked agent by agent (5)-(6). Dense: for N n up to about 1500.
struct GARRISON_EXPORT ErrorDynamics {
  Matrix reduction;  ///< I - Kb D_C, block diagonal, Nn x Nn
  Matrix Ahat;       ///< (I - Kb D_C)(W kron A)
  Matrix injection;  ///< Kb Dbar_C, Nn x N: what measurement noise and attacks do to the estimates
};
GARRISON_EXPORT ErrorDynamics error_dynamics(const Setting& s, const GainMatrices& K);

/// rho(Ahat) without forming it: Arnoldi's method on the blocks, for N n in the thousands.
GARRISON_EXPORT double error_radius(const Setting& s, const GainMatrices& K);

/// Exact stationary second moments (docs/filters/structural.md#d11, d15): no bound, no norm.
struct GARRISON_EXPORT Stationary {
  double rho = kNaN;                ///< rho(Ahat) < 1
  Matrix Q;                         ///< covariance of the stacked error, Nn x Nn
  std::vector<Matrix> covariances;  ///< Gam_h = cov(r(k+h), r(k)), N x N, h = 0..lags
  Vector residual_std;              ///< of r_i = y_i - c_i'xhat_i(k|k)
  Vector innovation_std;            ///< of y_i - c_i'xhat_i(k|k-1)
  Matrix dc_gain;                   ///< steady residual (row) per unit constant attack (column)
  Matrix dc_error;                  ///< steady stacked error per unit constant attack, Nn x N
};
/// @throws InvalidInput when rho(Ahat) >= 1: there is no steady state.
GARRISON_EXPORT Stationary stationary(const Setting& s, const GainMatrices& K, int lags = 0);

/// Noise-free residuals from e = 0 while y_agent is off by 1 from row 0 on: rows x N.
GARRISON_EXPORT Matrix step_response(const Setting& s, const GainMatrices& K, int agent, int rows);
/// (18): |c_i'K_i c_j| / |c_j'K_j c_j - 1|, 0 on the diagonal, infinite where the denominator is 0. It speaks
/// of the first instant of an attack only (docs/filters/structural.md#d18).
GARRISON_EXPORT Matrix isolation_ratios(const Setting& s, const GainMatrices& K);
/// sum_j W(i, j) A xhat_j for every agent: N x n from N x n.
GARRISON_EXPORT Matrix predictions(const Setting& s, const MatrixRef& estimates);

/// (10) and (16). `printed` takes the paper's Rbar, which is false when measurements are shared
/// (docs/filters/structural.md#d12); the corrected one holds. Infinite when |Ahat|_2 >= 1 (d13 there).
struct GARRISON_EXPORT CovarianceBound {
  double a1, a2, b, Rbar_norm, bound, Q1;
};
GARRISON_EXPORT CovarianceBound covariance_bound(const Setting& s, const GainMatrices& K, bool printed);

}  // namespace garrison::structural
