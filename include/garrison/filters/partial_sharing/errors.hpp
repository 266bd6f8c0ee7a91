// SPDX-License-Identifier: Apache-2.0
// The error of the whole network: e(k+1) = At e + noise + Ga delta (28), its exact covariance (29), what the
// paper has for it, when it is stable, and the full solution to compare with.
#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <vector>

#include "garrison/filters/partial_sharing/setting.hpp"

namespace garrison::partial_sharing {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Lc(k): block (i,i) is the sum of S_j over the neighbours j of i, block (i,j) is -S_j
/// (docs/filters/partial_sharing.md#m6). N m x N m.
Sparse coupling(const Setting& setting, std::int64_t k);
/// At(k) = blockdiag(A - K_i H_i) - C Lc(k) and Ga(k) = C (E (x) I) S(k) for given gains.
Sparse error_step(const Setting& setting, const std::vector<LocalGains>& gains, std::int64_t k);
Sparse attack_step(const Setting& setting, const std::vector<LocalGains>& gains, std::int64_t k);
/// Qt = blockdiag(K_i R_i K_i') + 11' (x) Q.
Matrix noise_covariance(const Setting& setting, const std::vector<LocalGains>& gains);
/// One step of (29); `Sigma` empty: no attack.
Matrix covariance_step(const Setting& setting, const std::vector<LocalGains>& gains, std::int64_t k,
                       const Matrix& P, const Matrix& Sigma);

/// Attack covariance of the network, N m x N m, zero outside the Byzantine agents.
/// @throws InvalidInput when it is not symmetric positive semidefinite, or nonzero on a regular agent
GARRISON_EXPORT void check_attack(const Setting& setting, const MatrixRef& Sigma,
                                  const std::vector<int>& byzantine);
/// Sorted, each once, inside the network. @throws InvalidInput otherwise
void check_byzantine(const Setting& setting, const std::vector<int>& byzantine);

struct GARRISON_EXPORT Trajectory {
  std::vector<double> nmse;  ///< tr P(k), k = 0..steps (27)
  Matrix P;                  ///< P(steps)
};
/// (29) along Algorithm 1 with the gains of (9), (11) from P_0 on; `common`: equal initial errors (P_ij(0) =
/// P_0), else independent ones. `Sigma` (may be empty) acts from k0 on.
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
std::vector<Matrix> periodic_adjoint(const Setting& setting, const std::vector<LocalGains>& gains);

// What the paper calls the error covariance: local recursions (8), (23)-(26) with an attack term.

/// P_i = F_i P_i F_i' + K_i R_i K_i' + Q + C_i [(E (x) I)(W o Sigma)(E (x) I)']_ii C_i', per agent. These
/// drop the correlation of neighbours and are not the true covariance (docs/filters/partial_sharing.md#m14).
/// W chooses the reading:
/// - p_e 11': (26) as printed, an upper bound only for the worst Sigma (docs/filters/partial_sharing.md#m5)
/// - Selection::moments_uniform(): (25) exact over random starts;  Selection::moments_cycle(): (25) exact on
/// one cycle. `Sigma` empty: no attack. W: N m x N m, or 1 x 1 for a constant.
GARRISON_EXPORT std::vector<Matrix> local_covariances(const Setting& setting,
                                                      const std::vector<LocalGains>& gains, const Matrix& W,
                                                      const Matrix& Sigma);
/// (1/N) sum of traces (38).
GARRISON_EXPORT double mse(const std::vector<Matrix>& covariances);
/// MSE' after each of `steps` updates (8) with S(k), k = k0, k0+1, .., from the steady P_i on; gains not
/// recomputed.
GARRISON_EXPORT std::vector<double> recursion8(const Setting& setting, const std::vector<LocalGains>& gains,
                                               const Matrix& Sigma, std::int64_t k0, int steps);

// Three stability tests: the paper's gamma* (advisory), a certified interval, and the exact radius above.

/// Lambda_I,i = H_i'(R_i + H_i P_i H_i')^-1 H_i, equal to the printed form where that exists
/// (docs/filters/partial_sharing.md#m8); steady P_i.
GARRISON_EXPORT Matrix lambda_I(const Setting& setting, const LocalGains& gains, int agent);
/// (22) with p_e = `fraction`. 0: vacuous (some Lambda_I,i is singular); inf: nobody hears anybody. Not a
/// guarantee: Theorem 1 is false as printed for static selections (docs/filters/partial_sharing.md#m7).
GARRISON_EXPORT double gamma_star(const Setting& setting, const std::vector<LocalGains>& gains,
                                  double fraction);
/// M_f(g) = Lambda_I + g (Lambda_III Lc + Lc' Lambda_III') - g^2 Lc' Lambda_II Lc at phase f: V decreases
/// from f to f+1 in every direction where it is positive semidefinite.
GARRISON_EXPORT Matrix decrease_matrix(const Setting& setting, const std::vector<LocalGains>& gains,
                                       double gamma, std::int64_t phase);
/// Largest gamma in [0, 1e6] with lmin(M_f(gamma)) >= -1e-12 at every phase: up to here the error cannot
/// grow. M_f is concave in gamma, so the admissible ones form an interval.
GARRISON_EXPORT double gamma_lyapunov(const Setting& setting, const std::vector<LocalGains>& gains);

// The full solution (4)-(7): every agent would need its neighbours' cross-covariances. For comparison only.

struct GARRISON_EXPORT FullSolution {
  std::vector<Matrix> estimate;  ///< [k = 0..steps], N x m: predictions xhat_i(k)
  std::vector<double> trace;     ///< tr P(k), k = 0..steps
  std::vector<Matrix> K, C;      ///< gains of the last step, per agent
  Matrix P;                      ///< P(steps), N m x N m
};

/// (4)-(7) with K_i* as printed after (7) and C_i = gamma (A - K H_i) P_ii from its own block. Knows the
/// whole network, so it is no agent. K_i* minimises the next step's trace only: over time it is not always
/// better than Algorithm 1 (docs/filters/partial_sharing.md#m16), and agents do not know an attack, so Sigma
/// never enters the gains. `start`: N x m. `y`: per step the stacked measurements, steps x (sum of n_i); no
/// rows: only covariances, for `steps` steps. `delta`: per step the stacked perturbations, steps x N m, or no
/// rows.
/// @throws InvalidInput when a shape does not fit
GARRISON_EXPORT FullSolution full_solution(const Setting& setting, int steps, const MatrixRef& start,
                                           const MatrixRef& y, const MatrixRef& delta, const Matrix& Sigma,
                                           std::int64_t k0, bool common);

}  // namespace garrison::partial_sharing
