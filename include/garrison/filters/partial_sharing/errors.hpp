// SPDX-License-Identifier: Apache-2.0
// The error of the whole network: e(k+1) = At e + noise + Ga delta (28), and its exact covariance (29).
#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <vector>

#include "garrison/filters/partial_sharing/setting.hpp"

namespace garrison::partial_sharing {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Lc(k): block (i,i) is the sum of S_j over the neighbours j of i, block (i,j) is -S_j (note 6). N m x N m.
GARRISON_EXPORT Sparse coupling(const Setting& setting, std::int64_t k);
/// At(k) = blockdiag(A - K_i H_i) - C Lc(k) and Ga(k) = C (E (x) I) S(k) for given gains.
GARRISON_EXPORT Sparse error_step(const Setting& setting, const std::vector<LocalGains>& gains,
                                  std::int64_t k);
GARRISON_EXPORT Sparse attack_step(const Setting& setting, const std::vector<LocalGains>& gains,
                                   std::int64_t k);
/// Qt = blockdiag(K_i R_i K_i') + 11' (x) Q.
GARRISON_EXPORT Matrix noise_covariance(const Setting& setting, const std::vector<LocalGains>& gains);
/// One step of (29); `Sigma` empty: no attack.
GARRISON_EXPORT Matrix covariance_step(const Setting& setting, const std::vector<LocalGains>& gains,
                                       std::int64_t k, const Matrix& P, const Matrix& Sigma);

/// Attack covariance of the network, N m x N m, zero outside the Byzantine agents.
/// @throws InvalidInput when it is not symmetric positive semidefinite, or nonzero on a regular agent
GARRISON_EXPORT void check_attack(const Setting& setting, const MatrixRef& Sigma,
                                  const std::vector<int>& byzantine);
/// Sorted, each once, inside the network. @throws InvalidInput otherwise
GARRISON_EXPORT void check_byzantine(const Setting& setting, const std::vector<int>& byzantine);

struct GARRISON_EXPORT Trajectory {
  std::vector<double> nmse;  ///< tr P(k), k = 0..steps (27)
  Matrix P;                  ///< P(steps)
};
/// (29) along Algorithm 1 with the gains of (9), (11) from P_0 on; `common`: equal initial errors (P_ij(0) =
/// P_0, note 15), else independent ones. `Sigma` (may be empty) acts from k0 on.
GARRISON_EXPORT Trajectory error_covariance(const Setting& setting, int steps, const Matrix& Sigma,
                                            std::int64_t k0, bool common = true);
/// The mean of (29) when every selection is drawn anew, over agents and time, uniformly among the l-subsets.
GARRISON_EXPORT Trajectory error_covariance_iid(const Setting& setting, int steps, const Matrix& Sigma,
                                                std::int64_t k0, bool common = true);

/// Spectral radius of At(period-1) .. At(0), per step: the exact stability test. Steady gains.
GARRISON_EXPORT double cycle_radius(const Setting& setting, const std::vector<LocalGains>& gains);
/// The periodic solution of (29): P(f) when S(f) is about to be used, f = 0..period-1. Steady gains.
/// @throws InvalidInput "no steady state: ... unstable" when the cycle radius is not below 1
GARRISON_EXPORT std::vector<Matrix> periodic_covariance(const Setting& setting,
                                                        const std::vector<LocalGains>& gains,
                                                        const Matrix& Sigma);
/// The periodic solution of W(f) = I + At(f)' W(f+1) At(f): what one unit of error at phase f costs from then
/// on.
GARRISON_EXPORT std::vector<Matrix> periodic_adjoint(const Setting& setting,
                                                     const std::vector<LocalGains>& gains);

}  // namespace garrison::partial_sharing
