// SPDX-License-Identifier: Apache-2.0
// Recovery after lost messages (L): the table's bound plus an excess that decays, without knowing where the
// loss was. Needs honest messages and a relayed bound or a witness at the loss.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "garrison/certificate/table.hpp"

namespace garrison::certificate {

/// What an agent keeps: every agent behind its estimate was within x of the lossless run at time lam, and
/// nothing behind its estimate was lost after lam. Start: (0, 0). x = infinity: nothing is known.
struct LossState {
  std::int64_t lam = 0;
  double x = 0.0;

  bool operator==(const LossState&) const = default;
};

/// Excess tables, the same for all agents. Functions at run time are O(1) and do not allocate; they expect
/// states with lam <= t and x >= 0.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Recovery {
 public:
  Recovery() = default;
  /// Theorem L and Lemma 2: the homogeneous table (start 1, no noise, adaptive, moving set) with s attacked.
  /// @throws InvalidInput as table()
  Recovery(const Kernels& kernels, int s);

  const Gains& rb() const { return rb_; }  ///< (k, i), k = 0..K
  const Gains& re() const { return re_; }  ///< (k, j)
  int window() const { return static_cast<int>(rb_.rows()) - 1; }
  bool empty() const { return rb_.size() == 0; }
  /// What is left of the largest excess after K steps; below 1 it decays.
  double left() const { return rmax_(window()); }
  /// What one agent needs of it: a single column.
  Recovery of(Eigen::Index agent) const {
    Recovery part;
    part.rb_ = rb_.col(agent);
    part.re_ = re_.col(agent);
    part.rmax_ = rmax_;
    return part;
  }
  /// Of a design file: nothing leads out of its tables.
  bool fits(Eigen::Index columns) const noexcept {
    return rb_.rows() >= 2 && rb_.cols() == columns && re_.rows() == rb_.rows() && re_.cols() == columns &&
           rmax_.size() == rb_.rows();
  }

  /// The state seen at time t: carried over every multiple of K in (lam, t].
  LossState rebase(LossState state, std::int64_t t) const noexcept {
    const std::int64_t K = window();
    // Nothing stays nothing, and what is not known stays so: also where the table overflowed.
    if (state.x == 0.0 || !(state.x < kInfinity)) return {std::max(state.lam, t - t % K), state.x};
    for (std::int64_t next = (state.lam / K + 1) * K; next <= t; next += K)
      state = {next, carried(state.x, next - state.lam)};
    return state;
  }
  /// ||e_i(t)|| <= d_i(t) + this.
  double error_excess(Eigen::Index agent, LossState state, std::int64_t t) const noexcept {
    const LossState seen = rebase(state, t);
    return part(rb_(t - seen.lam, agent), seen.x);
  }
  /// level_j(t+1) = nominal level_j(t+1) + this.
  double level_excess(Eigen::Index agent, LossState state, std::int64_t t) const noexcept {
    const LossState seen = rebase(state, t);
    return part(re_(t - seen.lam, agent), seen.x);
  }
  /// Both seen at time t: the state that dominates both.
  LossState merge(LossState p, LossState q, std::int64_t t) const noexcept {
    p = rebase(p, t);
    q = rebase(q, t);
    if (std::pair(q.lam, q.x) < std::pair(p.lam, p.x)) std::swap(p, q);
    return {q.lam, std::max(q.x, carried(p.x, q.lam - p.lam))};
  }
  /// After a loss in step t that left the agent with ||e_i(t)|| <= b: (t, b + d), d = nominal d_i(t), with
  /// Gaussian noise including its quantile.
  static LossState lost(std::int64_t t, double b, double d) noexcept { return {t, b + d}; }

  template <class V>
  void visit(V& v) {
    v("rb", rb_);
    v("re", re_);
    v("rmax", rmax_);
  }

 private:
  static double part(double gain, double x) noexcept {
    if (x == 0.0) return 0.0;
    return x < kInfinity ? gain * x : kInfinity;
  }
  double carried(double x, std::int64_t steps) const noexcept { return part(rmax_(steps), x); }

  Gains rb_, re_;
  Vector rmax_;  // largest of each row of rb
};

}  // namespace garrison::certificate
