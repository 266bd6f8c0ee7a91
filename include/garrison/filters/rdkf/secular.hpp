// SPDX-License-Identifier: Apache-2.0
// The secular equation of the step: one unknown, a handful of Newton iterations.
#pragma once

#include <cmath>
#include <limits>

#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf::detail {

/// Least mu >= 0 with |u(mu)| <= lambda, u_i = rho_i / (d_i + mu), and u itself in place of rho.
///
/// Entries with d_i = 0 and |rho_i| <= `zero` do not count (u_i = 0). Smoothing is one more entry with d = 0
/// and rho = eps. Newton on 1/|u(mu)| = 1/lambda climbs monotonically from the left bound, so nothing guards
/// it. rho, divisor: `height` numbers, a multiple of kGroup, zeros behind the last; divisor is room.
template <int B>
GARRISON_INLINE Step secular(double* rho, double* divisor, const double* d, int height, const Price& price,
                             double zero) {
  using L = Lanes<B>;
  if (price.lambda == 0.0) {
    for (int i = 0; i < height; ++i) rho[i] = 0.0;
    return {kInfinity, 0};
  }
  double largest = price.smoothing;
  double steepest = 0.0;
  for (int i = 0; i < height; ++i) {
    const double size = std::abs(rho[i]);
    const bool counts = d[i] > 0.0 || size > zero;
    rho[i] = counts ? rho[i] : 0.0;
    divisor[i] = counts ? d[i] : 1.0;
    largest = counts && size > largest ? size : largest;
    steepest = d[i] > steepest ? d[i] : steepest;
  }
  if (largest == 0.0) return {};
  // Scaled: squares of huge entries would overflow.
  const double level = price.lambda / largest;
  const double eps = price.smoothing / largest;
  double all = eps * eps;
  double kernel = eps * eps;
  L squares = L::all(0.0);
  L within = L::all(0.0);
  const L scale = L::all(largest);
  for (int i = 0; i < height; i += kGroup) {
    L r = L::at(rho + i);
    L w = L::at(divisor + i);
    for (int p = 0; p < L::parts; ++p) {
      r.part[p] /= scale.part[p];
      w.part[p] = r.part[p] / w.part[p];
    }
    r.to(rho + i);
    squares.add(r, r);
    within.add(w, w);  // infinite where there is a kernel part, then not used
  }
  all += squares.sum();
  for (int i = 0; i < height; ++i) kernel += divisor[i] > 0.0 ? 0.0 : rho[i] * rho[i];
  double mu = 0.0;
  int iterations = 0;
  if (kernel > 0.0 || !(within.sum() <= level * level)) {
    mu = std::max({0.0, std::sqrt(all) / level - steepest, std::sqrt(kernel) / level});
    while (iterations < 100) {
      ++iterations;
      L square = L::all(0.0);
      L slope = L::all(0.0);
      const L shift = L::all(mu);
      for (int i = 0; i < height; i += kGroup) {
        L w = L::at(divisor + i);
        L u = L::at(rho + i);
        L uu;
        for (int p = 0; p < L::parts; ++p) {
          w.part[p] = 1.0 / (w.part[p] + shift.part[p]);
          u.part[p] *= w.part[p];
          uu.part[p] = u.part[p] * u.part[p];
          square.part[p] += uu.part[p];
        }
        slope.add(uu, w);
      }
      const double smooth = eps > 0.0 ? eps / mu : 0.0;
      const double length2 = square.sum() + smooth * smooth;
      const double next = mu + (std::sqrt(length2) / level - 1.0) * length2 /
                                   (slope.sum() + (eps > 0.0 ? smooth * smooth / mu : 0.0));
      if (!(next > mu * (1.0 + std::numeric_limits<double>::epsilon()))) break;
      mu = next;
    }
  }
  const L shift = L::all(mu);
  for (int i = 0; i < height; i += kGroup) {
    L u = L::at(rho + i);
    const L w = L::at(divisor + i);
    for (int p = 0; p < L::parts; ++p) u.part[p] = u.part[p] * scale.part[p] / (w.part[p] + shift.part[p]);
    u.to(rho + i);
  }
  return {mu, iterations};
}

/// The step at width B: u = dual solution, x += W u. See `solve`.
template <int B>
GARRISON_INLINE Step solve_at(const StepFactors& f, const Price& price, const double* y, double* x,
                              double* room) {
  using L = Lanes<B>;
  const int height = f.R.height;
  const int n = f.states();
  if (height == 0) return {};
  double* const u = room;
  double* const divisor = room + height;
  double* const b = room + 2 * height;
  double* const Mx = room + 3 * height;
  double* const push = room + 4 * height;
  product<B>(f.R, y, b);
  product<B>(f.K, x, Mx);
  L b2 = L::all(0.0);
  L Mx2 = L::all(0.0);
  for (int i = 0; i < height; i += kGroup) {
    const L left = L::at(b + i);
    const L right = L::at(Mx + i);
    b2.add(left, left);
    Mx2.add(right, right);
    L r;
    for (int p = 0; p < L::parts; ++p) r.part[p] = left.part[p] - right.part[p];
    r.to(u + i);
  }
  const double zero = std::max(1e-14 * (std::sqrt(b2.sum()) + std::sqrt(Mx2.sum())), 1e-290);
  const Step step = secular<B>(u, divisor, f.d.data(), height, price, zero);
  product<B>(f.W, u, push);
  for (int k = 0; k < n; ++k) x[k] += push[k];
  return step;
}

}  // namespace garrison::rdkf::detail
