// SPDX-License-Identifier: Apache-2.0
// Recovery after lost messages (L): the table's bound plus an excess that decays, without knowing where the
// loss was. Needs honest messages and a relayed bound or a witness at the loss.
#pragma once

#include "garrison/certificate/table.hpp"

namespace garrison::certificate {

/// What an agent keeps: every agent behind its estimate was within x of the lossless run at time lam, and
/// nothing behind its estimate was lost after lam. Start: (0, 0).
struct LossState {
  int lam = 0;
  double x = 0.0;
};

/// Excess tables, the same for all agents. Functions at run time are O(1) and do not allocate; they expect
/// states with lam <= t and x >= 0.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Recovery {
 public:
  /// Theorem L and Lemma 2: the homogeneous table (start 1, no noise, adaptive, moving set) with s attacked.
  /// @throws InvalidInput as table()
  Recovery(const Kernels& kernels, int s);

  const Gains& rb() const { return rb_; }  ///< (k, i), k = 0..K
  const Gains& re() const { return re_; }  ///< (k, j)
  int window() const { return static_cast<int>(rb_.rows()) - 1; }

  /// The state seen at time t: carried over every multiple of K in (lam, t].
  LossState rebase(LossState state, int t) const noexcept;
  /// ||e_i(t)|| <= d_i(t) + this.
  double error_excess(int agent, LossState state, int t) const noexcept;
  /// level_j(t+1) = nominal level_j(t+1) + this.
  double level_excess(int agent, LossState state, int t) const noexcept;
  /// Both seen at time t: the state that dominates both.
  LossState merge(LossState p, LossState q, int t) const noexcept;
  /// After a loss in step t that left the agent with ||e_i(t)|| <= b: (t, b + d), d = nominal d_i(t), with
  /// Gaussian noise including its quantile.
  static LossState lost(int t, double b, double d) noexcept { return {t, b + d}; }

 private:
  Gains rb_, re_;
  Vector rmax_;  // largest of each row of rb
};

}  // namespace garrison::certificate
