// SPDX-License-Identifier: Apache-2.0
// The update of a group of agents: innovations, gains, estimates, predictions.
#pragma once

#include "garrison/filters/partial_sharing/freeze.hpp"
#include "garrison/filters/partial_sharing/group.hpp"

namespace garrison::partial_sharing {

/// Agents whose predictions have squares that sum to less than this are plain: no two of these numbers are
/// kHuge apart.
inline constexpr double kPlain = kHuge * kHuge / 16;

/// What all agents have in common.
struct Common {
  const double* A;  ///< column by column
  const double* Q;
  double gamma;
  bool freeze;
};

/// What came of a sample in some groups.
struct Outcome {
  alignas(64) double squares[kGroup]{};  ///< of predictions, summed by lane
  bool rested = false;                   ///< all gains of some group have become constant

  static bool plain(double sum) { return sum < kPlain; }
  bool plain() const {
    bool all = true;
    for (const double sum : squares) all = all && plain(sum);
    return all;
  }
};

/// One sample of a group, `B` lanes at a time.
template <int n>
struct Update {
  /// `u`: sum_j S_j (xbar_j - xhat_i), agent by agent. `next`: where the predictions of the next sample go,
  /// agent by agent; may be the group's own, and is afterwards. Adds to `outcome`.
  template <int B>
  GARRISON_INLINE static void run(const Common* common, Group<n>* group, const double* u, double* next,
                                  Outcome* outcome) noexcept {
    const bool moving = group->moving();
    for (int first = 0; first < group->agents; first += B)
      Lanes<B>(*common, *group, first).run(u, next, Block<B>::of(outcome->squares + first));
    outcome->rested |= moving && !group->moving();
    group->x = next;
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
  static constexpr int kStride = Group<n>::kLanes / B;
  static constexpr int N = n == Dynamic ? 1 : n;

 public:
  GARRISON_INLINE Lanes(const Common& common, Group<n>& group, int first)
      : common_(common), group_(group), first_(first), used_(std::min(B, group.agents - first)) {}

  GARRISON_INLINE void run(const double* all_u, double* next, V* squares) noexcept {
    const int m = states();
    const int q = group_.q;
    const bool few = Group<n>::on_stack(m, q);
    using Kernel = Recursion<n, B>;
    alignas(64) double
        stack[n == Dynamic ? 1 : (Kernel::scratch(N) + N * Kernel::scratch_per_row(N) + 6 * N) * B];
    V* const scratch = Block<B>::of(few ? stack : group_.scratch);
    V* const x = scratch;
    V* const u = x + m;
    V* const steady = u + m;
    V* const e = steady + m;
    V* const white = e + q;
    V* const row = white + q;
    V* const own = row + m;
    V* const rows = own + Kernel::scratch(m);
    const auto skipped = static_cast<std::ptrdiff_t>(first_) * m;
    load_lanes<n, B>(group_.x + skipped, m, used_, x);
    load_lanes<n, B>(all_u + skipped, m, used_, u);
    innovations(x, e);

    const unsigned everybody = Group<n>::all(used_);
    const unsigned frozen = group_.frozen >> first_ & everybody;
    if (frozen != 0) apply_steady(x, u, e, steady);
    V change{};
    if (frozen != everybody) {
      Kernel recursion(own, rows, m, q);
      V* const P = array(group_.P);
      if (!common_.freeze)
        for (int k = 0; k < packed(m); ++k) array(group_.G)[k * kStride] = P[k * kStride];
      recursion.factor(P, kStride);
      for (int r = 0; r < q; ++r) {
        whitened(r, row);
        recursion.use_row(r, row);
      }
      whiten(e, white);
      recursion.correct(white, u, common_.gamma, x);
      V limit{};  // of the trace; nothing is below 0
      for (int lane = 0; lane < used_; ++lane) limit[lane] = is_frozen(lane) ? 0.0 : kLargestVariance;
      recursion.predict(common_.A, common_.Q, P, kStride, limit, change);
      if (frozen != 0)
        for (int i = 0; i < m; ++i) x[i] = limit > 0.0 ? x[i] : steady[i];
    }
    predict(frozen == everybody ? steady : x, next, squares);
    if (common_.freeze && frozen != everybody)
      for (int lane = 0; lane < used_; ++lane)
        if (!is_frozen(lane) && change[lane] <= kConverged) freeze<n>(common_.gamma, group_, first_ + lane);
  }

 private:
  GARRISON_INLINE int states() const { return n == Dynamic ? group_.m : n; }
  GARRISON_INLINE bool is_frozen(int lane) const { return group_.is_frozen(first_ + lane); }
  GARRISON_INLINE V* array(double* which) const { return Block<B>::of(which + first_); }

  /// e = y - H xhat, missing entries 0; leaves them in y, missing ones NaN.
  GARRISON_INLINE void innovations(const V* x, V* e) {
    V* const y = array(group_.y);
    const V* const C = array(group_.C);
    const int m = states();
    for (int r = 0; r < group_.q; ++r) {
      V innovation = y[r * kStride];
      for (int k = 0; k < m; ++k) innovation -= C[(r * m + k) * kStride] * x[k];
      const V square = innovation * innovation;
      y[r * kStride] = square < kHuge * kHuge ? innovation : V{} + kNaN;
      e[r] = square < kHuge * kHuge ? innovation : V{};
    }
  }

  /// out = W e
  GARRISON_INLINE void whiten(const V* e, V* out) {
    const V* const W = array(group_.W);
    for (int r = 0; r < group_.q; ++r) {
      V sum{};
      for (int c = 0; c <= r; ++c) sum += W[packed(r, c) * kStride] * e[c];
      out[r] = sum;
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
    V fixed[kOnStack<n>];  // in registers: the compiler takes `out` for a place where G might be
    V* const z = n == Dynamic ? out : fixed;
    for (int i = 0; i < m; ++i) z[i] = x[i];
    for_each_state<n>(m, [&](auto a) GARRISON_INLINED {
      z[a] += G[packed(a, a) * kStride] * u[a];
      for_each_state<n>(m, [&](auto i) GARRISON_INLINED {
        if (i <= a) return;
        const V entry = G[packed(i, a) * kStride];
        z[i] += entry * u[a];
        z[a] += entry * u[i];
      });
    });
    for (int r = 0; r < group_.q; ++r)
      for_each_state<n>(m, [&](auto i) GARRISON_INLINED { z[i] += K[(r * m + i) * kStride] * e[r]; });
    for (int i = 0; i < m; ++i) out[i] = z[i];
  }

  /// z, and A z agent by agent.
  GARRISON_INLINE void predict(V* z, double* next, V* squares) {
    V* const kept = array(group_.z);
    const double* const A = common_.A;
    const int m = states();
    V fixed[kOnStack<n>];
    V* const moved = n == Dynamic ? kept : fixed;  // one lane then: agent by agent is the same
    for (int i = 0; i < m; ++i) z[i] += 0.0;       // rows of zeros may have changed the sign of a zero
    V sum_of_squares{};
    for_each_state<n>(m, [&](auto i) GARRISON_INLINED {
      V sum = A[i] * z[0];
      for (int k = 1; k < m; ++k) sum += A[k * m + i] * z[k];
      sum_of_squares += sum * sum;
      moved[i] = sum;
    });
    store_lanes<n, B>(moved, m, used_, next + static_cast<std::ptrdiff_t>(first_) * m);
    for (int i = 0; i < m; ++i) kept[i * kStride] = z[i];
    *squares += sum_of_squares;
  }

  const Common& common_;
  Group<n>& group_;
  const int first_;
  const int used_;
};

/// One sample of a group: see Update.
template <int n>
void update(const Common& common, Group<n>& group, const double* u, double* next, Outcome& outcome) noexcept {
  if constexpr (n == Dynamic)
    Update<n>::template run<1>(&common, &group, u, next, &outcome);
  else
    run_widest_of<Update<n>, n>(&common, &group, u, next, &outcome);
}

}  // namespace garrison::partial_sharing
