// SPDX-License-Identifier: Apache-2.0
// One agent of a plant that changes in time. Included by filter.hpp.
#pragma once

#include "garrison/filters/partial_sharing/filter.hpp"

namespace garrison {
namespace partial_sharing {

/// A P A' + Q
inline Matrix predicted(const Matrix& A, const Matrix& P, const Matrix& Q) {
  const Matrix first = A * P * A.transpose() + Q;
  return (first + first.transpose()) / 2.0;
}

/// P(k) -> P(k+1) of (11), for one lane: rows and their noise are those of k, A and Q lead to k+1.
template <int n>
void move_covariance(const double* A, const double* Q, Group<n>& group, int lane) noexcept {
  using One = Block<1>;
  using Kernel = Recursion<n, 1>;
  constexpr int N = n == Dynamic ? 1 : n;
  constexpr int kStride = Group<n>::kLanes;
  const int m = group.m;
  const int q = group.q;
  double stack[n == Dynamic ? 1 : Kernel::scratch(N) + N * Kernel::scratch_per_row(N) + N];
  double* const row = Group<n>::on_stack(m, q) ? stack : group.scratch;
  double* const own = row + m;
  Kernel recursion(One::of(own), One::of(own + Kernel::scratch(m)), m, q);
  One::type* const P = One::of(group.P + lane);
  for (int k = 0; k < packed(m); ++k) group.at(group.P, k, lane) = group.at(group.G, k, lane);
  take_in<n>(recursion, group, lane, row);
  One::type unused{};
  recursion.predict(A, Q, P, kStride, One::type{} + kLargestVariance, unused);
}

}  // namespace partial_sharing

template <int n>
void PartialSharing::vary(const Local& l, const Gains& g, const Change& change, Eigen::Index first,
                          State<n>& s) noexcept {
  partial_sharing::Group<n>& group = *s.group;
  const int nn = dimension<n>(l);
  const Matrix& Q = change.Q != nullptr ? *change.Q : g.Q;
  const auto lane = [&](double* array, int k) -> double& { return group.at(array, k, s.lane); };
  if (group.started) {
    partial_sharing::move_covariance<n>(l.A, Q.data(), group, s.lane);
  } else if (!g.given) {
    const Matrix A = Eigen::Map<const Matrix>(l.A, nn, nn);
    const Matrix P = partial_sharing::predicted(A, g.before, Q);
    for (int i = 0; i < nn; ++i)
      for (int k = 0; k <= i; ++k) lane(group.P, packed(i, k)) = P(i, k);
  }
  if (group.started || !g.given) multiply<n>(l.A, estimate<n>(s).data(), group.prediction(s.lane), nn);
  use_sensor<n>(l, g, change.W, first, s);
}

}  // namespace garrison
