// SPDX-License-Identifier: Apache-2.0
// The update of one agent: consensus on shared entries, gains, estimate. Included by filter.hpp.
#pragma once

#include "garrison/filters/partial_sharing/filter.hpp"

namespace garrison {

template <int n>
struct PartialSharing::Update {
  /// B: doubles per register.
  template <int B>
  GARRISON_INLINE static void run(const Local* local, const Gains* gains, State<n>* state,
                                  const Inbox<Message<n>>* received) noexcept;
};

template <int n>
template <int B>
GARRISON_INLINE void PartialSharing::Update<n>::run(const Local* local, const Gains* gains, State<n>* state,
                                                    const Inbox<Message<n>>* received) noexcept {
  const Local& l = *local;
  const Gains& g = *gains;
  State<n>& s = *state;
  const Inbox<Message<n>>& inbox = *received;
  using namespace partial_sharing;
  const int m = dimension<n>(l);
  const auto mm = static_cast<std::size_t>(m);
  const int q = l.outputs;
  double* const P = s.room.get();
  double* const G = P + mm * mm;
  double* const K = G + mm * mm;
  double* const y = measurements(l, s);
  double stack[n == Dynamic ? 1 : 3 * kSquare<n> + 5 * static_cast<std::size_t>(n == Dynamic ? 0 : n)];
  double* const S = n == Dynamic ? y + q : stack;
  double* const T = S + mm * mm;
  double* const next = T + mm * mm;
  double* const u = next + mm * mm;
  double* const w = u + m;
  double* const x = w + m;
  double* const v = x + m;
  double* const f = v + m;

  // u = sum_j S_j (xbar_j - xhat_i)
  for (int a = 0; a < m; ++a) u[a] = 0.0;
  for (int a = 0; a < m; ++a) x[a] = s.x[a];
  for (std::size_t j = 0; j < inbox.size(); ++j) {
    const Message<n>& heard = inbox[j];
    if (heard.t != s.t) continue;
    for (int k = 0; k < heard.count; ++k) {
      const auto a = heard.entry[static_cast<std::size_t>(k)];
      const double difference = heard.value[static_cast<std::size_t>(k)] - x[a];
      if (std::abs(difference) < kHuge) u[a] += difference;
    }
  }

  // e = W (y - H xhat), missing entries 0
  const Sensor& sensor = g.sensors[static_cast<std::size_t>(l.id)];
  int used = 0;
  for (int r = 0; r < q; ++r) {
    double innovation = y[r];
    for (int k = 0; k < m; ++k) innovation -= l.C[r * m + k] * x[k];
    const bool there = std::abs(innovation) < kHuge;
    used += there ? 1 : 0;
    y[r] = there ? innovation : 0.0;
  }
  s.statistic = used == 0 ? kNaN : 0.0;
  for (int r = q; r-- > 0;) {  // backwards: W is lower triangular, in place
    double e = 0.0;
    for (int c = 0; c <= r; ++c) e += sensor.W[static_cast<std::size_t>(r * q + c)] * y[c];
    y[r] = e;
    if (used > 0) s.statistic = std::max(s.statistic, std::abs(e));
  }
  s.verdict = used == 0 ? Verdict::silent : Verdict::cleared;

  if (!s.frozen) {
    const Recursion recursion{P, S, T, K, v, f, sensor.H.data(), l.A, g.Q.data(), q, m};
    const double change = advance<n, B>(recursion, next);
    kernel::zero<n, B>(w, m);
    for (int a = 0; a < m; ++a) kernel::axpy<n, B>(u[a], T + a * m, w, m);
    for (int a = 0; a < m; ++a) kernel::axpy<n, B>(g.gamma * w[a], S + a * m, x, m);
    if (g.freeze && change <= kConverged) {
      s.frozen = true;
      for (int c = 0; c < m; ++c) {
        kernel::zero<n, B>(G + c * m, m);
        for (int k = 0; k < m; ++k) kernel::axpy<n, B>(g.gamma * T[c * m + k], S + k * m, G + c * m, m);
      }
    }
  } else {
    for (int a = 0; a < m; ++a) kernel::axpy<n, B>(u[a], G + a * m, x, m);
  }
  for (int r = 0; r < q; ++r) kernel::axpy<n, B>(y[r], K + r * m, x, m);
  for (int a = 0; a < m; ++a) s.z[a] = x[a];
}

}  // namespace garrison
