// SPDX-License-Identifier: Apache-2.0
// What the analysis of the partial-sharing filter works on: the problem, and the gains of Algorithm 1.
#pragma once

#include <vector>

#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"

namespace garrison::partial_sharing {

/// Letters of the paper; N agents, m states. All matrices are checked.
struct GARRISON_EXPORT Setting {
  Matrix A, Q, P0;
  std::vector<Matrix> H, R;             ///< n_i x m, n_i x n_i; no rows: an agent without sensors
  std::vector<std::vector<int>> hears;  ///< N_i, sorted
  Selection selection;
  double gamma = 0.0;

  int agents() const { return static_cast<int>(H.size()); }
  int states() const { return static_cast<int>(A.rows()); }
  Eigen::Index size() const { return static_cast<Eigen::Index>(agents()) * states(); }
  /// p_e = l/m with the largest l_i.
  double shared_fraction() const;
};

/// @throws InvalidInput when the model has no covariances, an R_i is singular, or a parameter does not fit
GARRISON_EXPORT Setting make_setting(const PartialSharing::Params& params, const Model& model,
                                     const Network& network);

/// Payload of all messages of one sample: eight bytes per shared entry and hearing neighbour.
GARRISON_EXPORT std::int64_t bytes_per_step(const Setting& setting);

/// Gains of one agent at one time.
struct GARRISON_EXPORT LocalGains {
  Matrix P;  ///< P_i(k), covariance of the prediction
  Matrix K;  ///< (9), m x n_i
  Matrix C;  ///< gamma (A - K_i H_i) P_i
  Matrix F;  ///< A - K_i H_i
};

/// (9) and (11) of one agent from a covariance on, by the recursion that the filter itself runs.
/// Threads: one at a time.
class GARRISON_EXPORT LocalRecursion {
 public:
  /// From P_0 of the setting.
  LocalRecursion(const Setting& setting, int agent);
  const Matrix& P() const { return P_; }
  void restart(const Matrix& P) { P_ = P; }
  /// Gains of this k; moves on to P_i(k+1). `change`, if given, receives how much P changed.
  LocalGains step(double* change = nullptr);
  /// Gain of the innovations in the estimate and gamma times the filtered covariance of the last `step`, as
  /// the filter keeps them.
  Matrix filter_gain() const { return Kw_ * W_; }
  Matrix consensus_gain() const;

 private:
  const Setting& setting_;
  const Matrix& H_;
  Matrix W_;   // whitener of R_i
  Matrix Hw_;  // m x n_i: whitened rows as columns
  Matrix P_, Kw_;
  Vector packed_P_, packed_G_, scratch_;
};

/// Limit of (11) from P_0: doubling, then the recursion itself until nothing moves but rounding.
/// @throws InvalidInput "agent i: (A, H_i) is not detectable" when (11) diverges; neighbours do not help
/// (docs/filters/partial_sharing.md)
GARRISON_EXPORT LocalGains steady_gains(const Setting& setting, int agent);
GARRISON_EXPORT std::vector<LocalGains> steady_gains(const Setting& setting);
/// Agents whose (11) has no limit, sorted.
std::vector<int> undetectable_agents(const Setting& setting);
/// W with W R W' = I, lower triangular. @throws InvalidInput when R is not positive definite
Matrix whitener(const Matrix& R, int agent);

}  // namespace garrison::partial_sharing
