// SPDX-License-Identifier: Apache-2.0
// Gain designs for (4). All gains satisfy K_i = K_i Pi_i, Pi_i the projector on span{c_j : U(i, j) = 1}.
#pragma once

#include <span>
#include <string>

#include "garrison/filters/structural/setting.hpp"

namespace garrison::structural {

/// Coupled Riccati recursion (docs/filters/structural.md#d-riccati): P_i^- = A (sum_j W_ij P_j) A' + E
/// and K_i its Kalman gain, N recursions of n x n. P_i >= cov(e_i) (Jensen); a bounded fixed point with E > 0
/// certifies rho(Ahat) < 1. O(N n^3) a sweep.
struct GARRISON_EXPORT RiccatiGains {
  GainMatrices K;
  std::vector<Matrix> P;       ///< n x n per agent: a bound of the stationary error covariance
  std::vector<Matrix> Pprior;  ///< the same before the measurement
  bool converged = false;      ///< else K, P are those of the last sweep and nothing is certified
  bool diverged = false;       ///< P grows beyond any bound: there is no fixed point
  int sweeps = 0;              ///< steps of Newton's method, where the sweeps are slow, count as one each
};
/// Where 400 sweeps do not settle (little process noise), Newton's method does, from the solution for more
/// noise.
GARRISON_EXPORT RiccatiGains coupled_riccati(const Setting& s, int most_sweeps = 20000,
                                             double tolerance = 1e-14);

/// Kalman gains of the diagonal blocks of the joint covariance (greedy per agent), O((N n)^3) a sweep.
struct GARRISON_EXPORT JointGains {
  GainMatrices K;
  bool converged = false;
  int sweeps = 0;
};
GARRISON_EXPORT JointGains joint_kalman(const Setting& s, int most_sweeps = 20000, double tolerance = 1e-14);

/// K_i minimises |(I - K_i D_i) A| (Frobenius norm); closed form, no noise model.
GARRISON_EXPORT GainMatrices projection_gains(const Setting& s);

/// Minimises tr Q over all block-diagonal gains with rho(Ahat) < 1 (L-BFGS with adjoint gradients, O((N n)^3)
/// each) from `start`. A start that is not Schur is reached by discounting: A is scaled down until it is, and
/// the scale is raised to 1 step by step.
/// `hubs`: agents j for which (18) with 0 <= epsilon < 1 holds for all i; none = no isolation constraint.
/// @throws DesignInfeasible with the spectral radius reached when none below 1 was found.
GARRISON_EXPORT GainMatrices h2_gains(const Setting& s, const GainMatrices& start,
                                      std::span<const int> hubs = {}, double epsilon = 0.01);

/// The gains of `method` with rho(Ahat) < 1 guaranteed: "riccati", "kalman", "projection", "h2", or "auto",
/// the first of riccati, kalman, h2 that is Schur.
struct GARRISON_EXPORT Designed {
  GainMatrices K;
  std::string method;
  double rho = kNaN;
  std::vector<Matrix> P;  ///< bounds of cov(e_i) where the coupled Riccati recursion settled; else empty
};
/// @throws DesignInfeasible with the spectral radius reached.
GARRISON_EXPORT Designed design_gains(const Setting& s, const std::string& method);

/// One unstable scalar state that agent 0 observes alone and shares with nobody: the gain k with the least
/// spectral radius of A diag(1 - k c, 1, ...) W, and that radius. Lemma 2 does not make it smaller than 1
/// (docs/filters/structural.md#d20).
struct GARRISON_EXPORT ScalarGainChoice {
  double gain, radius;
};
GARRISON_EXPORT ScalarGainChoice best_scalar_gain(double a, const MatrixRef& W);

}  // namespace garrison::structural
