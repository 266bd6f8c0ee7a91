// SPDX-License-Identifier: Apache-2.0
// The update of a group of agents: innovations, gains, estimates, predictions.
#pragma once

#include "garrison/filters/partial_sharing/freeze.hpp"
#include "garrison/filters/partial_sharing/group.hpp"

namespace garrison::partial_sharing {

/// Predictions below this are plain: no two of them are kHuge apart.
inline constexpr double kPlain = kHuge / 4;

/// What all agents have in common.
struct Common {
  const double* A;  ///< column by column
  const double* Q;
  double gamma;
  bool freeze;
};

/// One sample of a group, `B` lanes at a time.
template <int n>
struct Update {
  /// `u`: sum_j S_j (xbar_j - xhat_i), agent by agent. `next`: where the predictions of the next sample go,
  /// agent by agent; may be the group's own. `plain` turns false when one of them is huge or not a number.
  template <int B>
  GARRISON_INLINE static void run(const Common* common, Group<n>* group, const double* u, double* next,
                                  bool* plain) noexcept {
    for (int first = 0; first < group->agents; first += B)
      Lanes<B>(*common, *group, first).run(u, next, plain);
    group->started = true;
  }

 private:
  template <int B>
  class Lanes;
};

template <int n>
template <int B>
class Update<n>::Lanes {
  using V = typename Block<B>::type;
  using Mask = decltype(V{} < V{});
  static constexpr int kStride = Group<n>::kLanes / B;
  static constexpr int N = n == Dynamic ? 1 : n;

 public:
  GARRISON_INLINE Lanes(const Common& common, Group<n>& group, int first)
      : common_(common), group_(group), first_(first), used_(std::min(B, group.agents - first)) {}

  GARRISON_INLINE void run(const double* all_u, double* next, bool* plain) noexcept {
    const int m = states();
    const int q = group_.q;
    const bool few = Group<n>::on_stack(m, q);
    using Kernel = Recursion<n, B>;
    alignas(64) double
        stack[n == Dynamic ? 1 : (Kernel::scratch(N) + N * Kernel::scratch_per_row(N) + 5 * N) * B];
    V* const scratch = Block<B>::of(few ? stack : group_.at(group_.scratch));
    V* const x = scratch;
    V* const u = x + m;
    V* const steady = u + m;
    V* const e = steady + m;
    V* const row = e + q;
    V* const own = row + m;
    V* const rows = own + Kernel::scratch(m);
    load(group_.x, x);
    load(all_u, u);
    innovations(x, e);

    Mask live{};
    int frozen = 0;
    for (int lane = 0; lane < used_; ++lane) {
      const bool still = group_.frozen[static_cast<std::size_t>(first_ + lane)];
      live[lane] = still ? 0 : -1;
      frozen += still ? 1 : 0;
    }
    if (frozen > 0) apply_steady(x, u, e, frozen == used_ ? x : steady);
    V change{};
    if (frozen < used_) {
      Kernel recursion(own, rows, m, q);
      V* const P = array(group_.P);
      recursion.factor(P, kStride);
      for (int r = 0; r < q; ++r) {
        whitened(r, row);
        recursion.use_row(r, row);
      }
      recursion.correct(e, u, common_.gamma, x);
      recursion.predict(common_.A, common_.Q, P, kStride, live, change);
      if (frozen > 0)
        for (int i = 0; i < m; ++i) x[i] = live ? x[i] : steady[i];
    }
    predict(x, next, plain);
    if (common_.freeze && frozen < used_)
      for (int lane = 0; lane < used_; ++lane)
        if (live[lane] != 0 && change[lane] <= kConverged) freeze<n>(common_.gamma, group_, first_ + lane);
  }

 private:
  GARRISON_INLINE int states() const { return n == Dynamic ? group_.m : n; }
  GARRISON_INLINE V* array(int which) { return Block<B>::of(group_.at(which) + first_); }

  /// Numbers agent by agent -> a lane per agent. Idle lanes repeat the last agent.
  GARRISON_INLINE void load(const double* from, V* to) const {
    const double* agent[B];
    for (int lane = 0; lane < B; ++lane)
      agent[lane] = from + static_cast<std::ptrdiff_t>(first_ + std::min(lane, used_ - 1)) * states();
    for (int i = 0; i < states(); ++i) {
      V all{};
      for (int lane = 0; lane < B; ++lane) all[lane] = agent[lane][i];
      to[i] = all;
    }
  }

  /// e = W (y - H xhat), missing entries 0; leaves the innovations in y.
  GARRISON_INLINE void innovations(const V* x, V* e) {
    V* const y = array(group_.y);
    const V* const C = array(group_.C);
    const V* const W = array(group_.W);
    const int m = states();
    for (int r = 0; r < group_.q; ++r) {
      V innovation = y[r * kStride];
      for (int k = 0; k < m; ++k) innovation -= C[(r * m + k) * kStride] * x[k];
      const auto there = (innovation < kHuge) & (innovation > -kHuge);
      y[r * kStride] = there ? innovation : V{} + kNaN;
      e[r] = there ? innovation : V{};
    }
    for (int r = group_.q; r-- > 0;) {  // backwards: W is lower triangular, in place
      V sum{};
      for (int c = 0; c <= r; ++c) sum += W[packed(r, c) * kStride] * e[c];
      e[r] = sum;
    }
  }

  /// Row r of W H_i.
  GARRISON_INLINE void whitened(int r, V* row) {
    const V* const C = array(group_.C);
    const V* const W = array(group_.W);
    const int m = states();
    for (int k = 0; k < m; ++k) {
      V sum = W[packed(r, 0) * kStride] * C[k * kStride];
      for (int c = 1; c <= r; ++c) sum += W[packed(r, c) * kStride] * C[(c * m + k) * kStride];
      row[k] = sum;
    }
  }

  /// out = x + G u + K e
  GARRISON_INLINE void apply_steady(const V* x, const V* u, const V* e, V* out) {
    const V* const G = array(group_.G);
    const V* const K = array(group_.K);
    const int m = states();
    for_each_state<n>(m, [&](auto i) GARRISON_INLINED {
      V sum = x[i];
      for (int a = 0; a < m; ++a) sum += G[(a < i ? packed(i, a) : packed(a, i)) * kStride] * u[a];
      for (int r = 0; r < group_.q; ++r) sum += K[(r * m + i) * kStride] * e[r];
      out[i] = sum;
    });
  }

  /// z, and A z agent by agent.
  GARRISON_INLINE void predict(V* z, double* next, bool* plain) {
    V* const kept = array(group_.z);
    const double* const A = common_.A;
    const int m = states();
    double spare[B * N];  // idle lanes have no place in `next`
    double* const all = next + static_cast<std::ptrdiff_t>(first_) * m;
    double* const to = n == Dynamic || used_ == B ? all : spare;
    for (int i = 0; i < m; ++i) z[i] += 0.0;  // rows of zeros may have changed the sign of a zero
    Mask is_plain = z[0] == z[0];
    for_each_state<n>(m, [&](auto i) GARRISON_INLINED {
      V sum = A[i] * z[0];
      for (int k = 1; k < m; ++k) sum += A[k * m + i] * z[k];
      is_plain &= (sum < kPlain) & (sum > -kPlain);
      kept[i * kStride] = z[i];
      for (int lane = 0; lane < B; ++lane) to[lane * m + i] = sum[lane];
    });
    if (to != all) std::copy_n(spare, used_ * m, all);
    for (int lane = 0; lane < used_; ++lane) *plain = *plain && is_plain[lane] != 0;
  }

  const Common& common_;
  Group<n>& group_;
  const int first_;
  const int used_;
};

/// One sample of a group: see Update. Returns whether all predictions are plain.
template <int n>
bool update(const Common& common, Group<n>& group, const double* u, double* next) noexcept {
  bool plain = true;
  if constexpr (n == Dynamic)
    Update<n>::template run<1>(&common, &group, u, next, &plain);
  else if constexpr (n == 4 || n == 8)  // every instruction set compiles it once more
    run_widest<Update<n>>(&common, &group, u, next, &plain);
  else
    Update<n>::template run<2>(&common, &group, u, next, &plain);
  return plain;
}

}  // namespace garrison::partial_sharing
