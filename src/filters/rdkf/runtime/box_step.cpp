// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/box_step.hpp"

#include <algorithm>
#include <cmath>

namespace garrison::rdkf {
namespace {

constexpr int kMostProximal = 60;

/// Views of one step's room; q numbers each.
struct Box {
  const BoxFactors& f;
  double lambda;
  int q;
  double* u;
  double* u0;      // centre of the proximal term
  double* r;       // b - M x, with x = x0 + W u
  double* p;       // step of the free entries
  double* free;    // 1 = strictly inside
  double* scale;   // |b| + |M x0| + lambda |H|: rounding of r
  double* factor;  // q x q

  double gradient(int i) const { return r[i] - f.proximal * (u[i] - u0[i]); }

  /// p = (H_FF + proximal I)^-1 gradient_F by Cholesky, in place of `factor`; 0 outside of F.
  void newton() const {
    int m = 0;
    int index[kMostBoxOutputs];
    int* const at = index;
    for (int i = 0; i < q && m < kMostBoxOutputs; ++i)
      if (free[i] != 0.0) at[m++] = i;
    for (int i = 0; i < q; ++i) p[i] = 0.0;
    for (int a = 0; a < m; ++a) {
      for (int b = 0; b <= a; ++b) {
        double sum = f.H(at[a], at[b]) + (a == b ? f.proximal : 0.0);
        for (int k = 0; k < b; ++k) sum -= factor[a * q + k] * factor[b * q + k];
        factor[a * q + b] = a == b ? std::sqrt(std::max(sum, 0.5 * f.proximal)) : sum / factor[b * q + b];
      }
    }
    for (int a = 0; a < m; ++a) {
      double sum = gradient(at[a]);
      for (int k = 0; k < a; ++k) sum -= factor[a * q + k] * p[at[k]];
      p[at[a]] = sum / factor[a * q + a];
    }
    for (int a = m; a-- > 0;) {
      double sum = p[at[a]];
      for (int k = a + 1; k < m; ++k) sum -= factor[k * q + a] * p[at[k]];
      p[at[a]] = sum / factor[a * q + a];
    }
  }

  /// Moves u by t p, and r and x with it.
  void move(double t, double* x) const {
    for (int i = 0; i < q; ++i) {
      if (p[i] == 0.0) continue;
      const double before = u[i];
      u[i] = std::clamp(u[i] + t * p[i], -lambda, lambda);
      const double du = u[i] - before;
      for (int k = 0; k < q; ++k) r[k] -= f.H(k, i) * du;
      for (Eigen::Index k = 0; k < f.W.rows(); ++k) x[k] += f.W(k, i) * du;
    }
  }

  /// Maximises the proximal sub-problem around u0; returns the iterations.
  int active_set(double* x) const {
    for (int iteration = 1; iteration <= 20 * q + 20; ++iteration) {
      newton();
      double t = 1.0;
      int blocking = -1;
      for (int i = 0; i < q; ++i) {
        if (p[i] == 0.0) continue;
        const double reach = ((p[i] > 0.0 ? lambda : -lambda) - u[i]) / p[i];
        if (reach < t) {
          t = reach;
          blocking = i;
        }
      }
      move(t, x);
      if (blocking >= 0) {
        u[blocking] = p[blocking] > 0.0 ? lambda : -lambda;
        free[blocking] = 0.0;
        continue;
      }
      int worst = -1;
      double most = 0.0;
      for (int i = 0; i < q; ++i) {
        if (free[i] != 0.0) continue;
        const double inward = (u[i] > 0.0 ? -gradient(i) : gradient(i)) - 1e-15 * scale[i];
        if (inward > most) {
          most = inward;
          worst = i;
        }
      }
      if (worst < 0) return iteration;
      free[worst] = 1.0;
    }
    return 20 * q + 20;
  }
};

}  // namespace

Step solve_box(const BoxFactors& f, double lambda, const double* y, double* x, double* room) noexcept {
  const int q = f.outputs();
  const auto n = static_cast<int>(f.W.rows());
  double* const b = room + 6 * q;
  Box box{f, lambda, q, room, room + q, room + 2 * q, room + 3 * q, room + 4 * q, room + 5 * q, room + 8 * q};
  if (lambda == 0.0) {
    std::fill_n(box.u, q, 0.0);
    return {kInfinity, 0};
  }
  for (int i = 0; i < q; ++i) {
    b[i] = 0.0;
    double Mx = 0.0;
    for (int k = 0; k < q; ++k) b[i] += f.R(i, k) * y[k];
    for (int k = 0; k < n; ++k) Mx += f.M(i, k) * x[k];
    box.u[i] = 0.0;
    box.free[i] = 1.0;
    box.scale[i] = std::abs(b[i]) + std::abs(Mx);
    box.r[i] = b[i] - Mx;
  }
  int iterations = 0;
  for (int outer = 0; outer < kMostProximal; ++outer) {
    std::copy_n(box.u, q, box.u0);
    iterations += box.active_set(x);
    bool settled = true;
    for (int i = 0; i < q; ++i) {
      // What the sums have lost: r from x itself, before the optimality of this entry is judged.
      double r = b[i];
      for (int k = 0; k < n; ++k) r -= f.M(i, k) * x[k];
      box.r[i] = r;
      const double wrong = box.free[i] != 0.0 ? std::abs(r) : box.u[i] > 0.0 ? -r : r;
      settled = settled && !(wrong > 1e-15 * box.scale[i]);
    }
    if (settled) break;
  }
  double square = 0.0;
  double largest = 0.0;
  bool saturated = false;
  for (int i = 0; i < q; ++i) {
    saturated = saturated || (box.free[i] == 0.0 && std::abs(box.r[i]) > 1e-14 * box.scale[i]);
    largest = std::max(largest, std::abs(box.r[i]));
  }
  if (!saturated || largest == 0.0) return {0.0, iterations};
  for (int i = 0; i < q; ++i) square += (box.r[i] / largest) * (box.r[i] / largest);
  return {largest * std::sqrt(square) / lambda, iterations};
}

}  // namespace garrison::rdkf
