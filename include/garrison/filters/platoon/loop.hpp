// SPDX-License-Identifier: Apache-2.0
// Analysis of the closed loop: Assumption 4, Lemma 2 and Theorem 4. L_g is symmetric with known eigenvalues,
// so P_0 = I (x) A - L_g (x) F_0 splits into N problems of size 2 (docs/filters/platoon.md#s9-blocks):
// O(N) for any N.
#pragma once

#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::platoon {

/// Eigenvalues of the grounded Laplacian L_g upwards: 2 - 2 cos((2l - 1) pi/(2N + 1)), l = 1..N.
/// @throws InvalidInput when vehicles < 1
GARRISON_EXPORT std::vector<double> grounded_eigenvalues(int vehicles);

/// Assumption 4: g_v > T g_s > 0 and T^2 g_s - 2 T g_v > -4/sigma_max(L_g). Equivalent to P_0 being Schur.
/// @throws InvalidInput when vehicles < 1, period is not > 0, or a gain is not finite
GARRISON_EXPORT bool assumption4(int vehicles, double period, double gs, double gv);

/// Factors of Lemma 2 for P_0. All but `rho` are NaN when P_0 is not Schur (rho >= 1).
struct LoopFactors {
  double rho;    ///< spectral radius of P_0
  double M_max;  ///< extreme eigenvalues of M, P_0' M P_0 - M = -I
  double M_min;
  double kappa;  ///< ||M|| + 2 ||M P_0||^2, the printed theta
  double xi;     ///< sqrt(2 kappa M_max/M_min): limsup ||E|| <= xi limsup ||delta|| as printed
  /// sum over k of ||P_0^k||: the sharper factor (docs/filters/platoon.md#s10-sum), up to and
  /// including the first term below 1e-9. NaN when that takes more than kMostTerms block powers.
  double l1;
};
inline constexpr double kMostTerms = 2e7;
/// @throws InvalidInput as assumption4
GARRISON_EXPORT LoopFactors loop_factors(int vehicles, double period, double gs, double gv);

/// Theorem 4: limsup of phi (4), from the largest asymptotic estimation error.
struct LoopBound {
  double eta;         ///< (31) as printed; misses the process noise in the neighbours' predictions
  double eta_safe;    ///< with it: + 2 sqrt(N) T (g_s + g_v) eps (docs/filters/platoon.md#e5)
  double bound;       ///< alpha + eta xi, as printed
  double bound_safe;  ///< alpha + eta_safe xi
  double
      bound_sharp;  ///< alpha + eta_safe l1/sqrt(N): the mean of N norms is at most the stacked norm/sqrt(N)
  double spacing;   ///< limsup |gap - desired gap| <= sqrt(2) eta_safe l1
};
/// `alpha` >= 0: limsup ||xhat_i - x_i|| for every i. @throws InvalidInput as assumption4, or for a bad eps,
/// alpha
GARRISON_EXPORT LoopBound theorem4(int vehicles, double period, double gs, double gv, double eps,
                                   double alpha);

}  // namespace garrison::platoon
