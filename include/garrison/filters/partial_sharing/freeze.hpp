// SPDX-License-Identifier: Apache-2.0
// The gains of an agent whose covariance has come to rest.
#pragma once

#include "garrison/filters/partial_sharing/group.hpp"

namespace garrison::partial_sharing {

/// Gain of whitened innovations, K (row by row of measurements), and G = gamma L M D M'L' (packed) of one
/// factored agent; numbers are `stride` apart. `room`: 2 m + q values.
template <int n>
void explicit_gains(Recursion<n, 1>& recursion, double gamma, int m, int q, double* room, double* K,
                    double* G, int stride) noexcept {
  using One = Block<1>;
  std::fill_n(room, 2 * m + q, 0.0);
  double* const u = room;
  double* const e = u + m;
  double* const out = e + q;
  for (int r = 0; r < q; ++r) {
    e[r] = 1.0;
    std::fill_n(out, m, 0.0);
    recursion.correct(One::of(e), One::of(u), gamma, One::of(out));
    for (int i = 0; i < m; ++i) K[static_cast<std::ptrdiff_t>(r * m + i) * stride] = out[i];
    e[r] = 0.0;
  }
  for (int a = 0; a < m; ++a) {
    u[a] = 1.0;
    std::fill_n(out, m, 0.0);
    recursion.correct(One::of(e), One::of(u), gamma, One::of(out));
    for (int i = a; i < m; ++i) G[static_cast<std::ptrdiff_t>(packed(i, a)) * stride] = out[i];
    u[a] = 0.0;
  }
}

/// Row r of W H_i of one agent.
template <int n>
void whitened_row(Group<n>& group, int lane, int r, double* row) noexcept {
  for (int k = 0; k < group.m; ++k) {
    row[k] = 0.0;
    for (int c = 0; c <= r; ++c)
      row[k] += group.at(group.W, packed(r, c), lane) * group.at(group.C, c * group.m + k, lane);
  }
}

/// The recursion takes in P and the rows of one agent; `row`: m values.
template <int n>
void take_in(Recursion<n, 1>& recursion, Group<n>& group, int lane, double* row) noexcept {
  using One = Block<1>;
  recursion.factor(One::of(group.P + lane), Group<n>::kLanes);
  for (int r = 0; r < group.q; ++r) {
    whitened_row(group, lane, r, row);
    recursion.use_row(r, One::of(row));
  }
}

/// K and G from P for one agent, which stands still from now on.
template <int n>
void freeze(double gamma, Group<n>& group, int lane) noexcept {
  using One = Block<1>;
  using Kernel = Recursion<n, 1>;
  constexpr int N = n == Dynamic ? 1 : n;
  constexpr int kStride = Group<n>::kLanes;
  const int m = group.m;
  const int q = group.q;
  double stack[n == Dynamic ? 1 : Kernel::scratch(N) + N * Kernel::scratch_per_row(N) + 4 * N];
  double* const row = Group<n>::on_stack(m, q) ? stack : group.scratch;
  double* const room = row + m;
  double* const own = room + 2 * m + q;
  Kernel recursion(One::of(own), One::of(own + Kernel::scratch(m)), m, q);
  take_in<n>(recursion, group, lane, row);
  explicit_gains<n>(recursion, gamma, m, q, room, group.K + lane, group.G + lane, kStride);
  // K W, the gain of the innovations as they are; forwards: W is lower triangular, in place
  for (int c = 0; c < q; ++c)
    for (int i = 0; i < m; ++i) {
      double sum = 0.0;
      for (int r = c; r < q; ++r)
        sum += group.at(group.W, packed(r, c), lane) * group.at(group.K, r * m + i, lane);
      group.at(group.K, c * m + i, lane) = sum;
    }
  group.set_frozen(lane, true);
}

}  // namespace garrison::partial_sharing
