// SPDX-License-Identifier: Apache-2.0
#include "dense.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/kernel/hypotenuse.hpp"

namespace garrison::certificate::detail {
namespace {

/// S becomes tridiagonal by reflections; (diagonal, squared side diagonal) in `d` and `e2`.
void tridiagonal(Eigen::Ref<Matrix> S, Eigen::Ref<Vector> d, Eigen::Ref<Vector> e2, Eigen::Ref<Vector> p) {
  const Eigen::Index n = S.rows();
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    const Eigen::Index m = n - k - 1;
    auto v = S.col(k).tail(m);
    const double length = v.norm();
    d(k) = S(k, k);
    e2(k) = length * length;
    if (m == 1 || length == 0.0) continue;
    v(0) += v(0) < 0.0 ? -length : length;
    const double h = 0.5 * v.squaredNorm();
    auto rest = S.bottomRightCorner(m, m);
    auto q = p.head(m);
    q.setZero();
    for (Eigen::Index j = 0; j < m; ++j) q += v(j) * rest.col(j);
    q /= h;
    q -= (0.5 * v.dot(q) / h) * v;
    for (Eigen::Index j = 0; j < m; ++j) rest.col(j) -= v * q(j) + q * v(j);
  }
  d(n - 1) = S(n - 1, n - 1);
}

/// How many eigenvalues of the tridiagonal matrix are below x (Sturm).
Eigen::Index below(const VectorRef& d, const VectorRef& e2, double x, double tiny) {
  Eigen::Index count = 0;
  double pivot = 1.0;
  for (Eigen::Index k = 0; k < d.size(); ++k) {
    pivot = d(k) - x - (k == 0 ? 0.0 : e2(k - 1) / pivot);
    if (std::abs(pivot) < tiny) pivot = -tiny;
    count += pivot < 0.0 ? 1 : 0;
  }
  return count;
}

}  // namespace

bool cholesky(Eigen::Ref<Matrix> S) noexcept {
  const Eigen::Index n = S.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!(S(k, k) > 0.0)) return false;
    auto column = S.col(k).tail(n - k);
    column /= std::sqrt(S(k, k));
    for (Eigen::Index j = k + 1; j < n; ++j) S.col(j).tail(n - j) -= S(j, k) * S.col(k).tail(n - j);
  }
  return true;
}

void solve_lower(const MatrixRef& L, Eigen::Ref<Vector> x) noexcept {
  const Eigen::Index n = x.size();
  for (Eigen::Index k = 0; k < n; ++k) {
    x(k) /= L(k, k);
    if (x(k) != 0.0) x.tail(n - k - 1) -= x(k) * L.col(k).segment(k + 1, n - k - 1);
  }
}

void solve_upper(const MatrixRef& L, Eigen::Ref<Vector> x) noexcept {
  const Eigen::Index n = x.size();
  for (Eigen::Index k = n; k-- > 0;)
    x(k) = (x(k) - L.col(k).segment(k + 1, n - k - 1).dot(x.tail(n - k - 1))) / L(k, k);
}

std::pair<double, double> extreme_eigenvalues(Eigen::Ref<Matrix> S, Eigen::Ref<Matrix> room) noexcept {
  const Eigen::Index n = S.rows();
  if (n == 0) return {0.0, 0.0};
  if (n == 1) return {S(0, 0), S(0, 0)};
  const double scale = S.cwiseAbs().maxCoeff();
  if (!(scale > 0.0) || !(scale <= kHuge)) return {scale > 0.0 ? kNaN : 0.0, scale > 0.0 ? kNaN : 0.0};
  S /= scale;
  if (n == 2) {  // most of the time of banks with two states, otherwise
    const double middle = 0.5 * (S(0, 0) + S(1, 1));
    const double apart = hypotenuse(0.5 * (S(0, 0) - S(1, 1)), S(1, 0));
    return {scale * (middle - apart), scale * (middle + apart)};
  }
  auto d = room.col(0).head(n);
  auto e2 = room.col(1).head(n);
  tridiagonal(S, d, e2, room.col(2));
  double reach = 0.0;  // every eigenvalue is within this of 0 (Gershgorin)
  for (Eigen::Index k = 0; k < n; ++k)
    reach = std::max(
        reach, std::abs(d(k)) + (k + 1 < n ? std::sqrt(e2(k)) : 0.0) + (k > 0 ? std::sqrt(e2(k - 1)) : 0.0));
  // The smallest x with at least `count` eigenvalues below it.
  const auto eigenvalue = [&](Eigen::Index count) {
    double lo = -reach;
    double hi = reach * (1.0 + 1e-15);
    for (int k = 0; k < 200; ++k) {
      const double mid = 0.5 * (lo + hi);
      if (!(mid > lo && mid < hi)) break;
      (below(d, e2, mid, 1e-300) >= count ? hi : lo) = mid;
    }
    return hi;
  };
  return {scale * eigenvalue(1), scale * eigenvalue(n)};
}

void diagonalise(Eigen::Ref<Matrix> S, Eigen::Ref<Matrix> U) noexcept {
  constexpr int kMostSweeps = 60;
  const Eigen::Index n = S.rows();
  U.setIdentity();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    bool rotated = false;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = i + 1; j < n; ++j) {
        const double a = S(i, j);
        // Small against both of its diagonal entries: nothing left to do.
        if (!(std::abs(a) > 1e-17 * std::sqrt(std::abs(S(i, i) * S(j, j))) && std::abs(a) > 1e-300)) continue;
        rotated = true;
        const double h = 0.5 * (S(j, j) - S(i, i)) / a;
        const double t = (h < 0.0 ? -1.0 : 1.0) / (std::abs(h) + hypotenuse(1.0, h));
        const double c = 1.0 / hypotenuse(1.0, t);
        const double s = t * c;
        for (Eigen::Index k = 0; k < n; ++k) {
          const double x = S(k, i);
          const double y = S(k, j);
          S(k, i) = c * x - s * y;
          S(k, j) = s * x + c * y;
        }
        for (Eigen::Index k = 0; k < n; ++k) {
          const double x = S(i, k);
          const double y = S(j, k);
          S(i, k) = c * x - s * y;
          S(j, k) = s * x + c * y;
        }
        S(i, j) = S(j, i) = 0.0;
        for (Eigen::Index k = 0; k < n; ++k) {
          const double x = U(k, i);
          const double y = U(k, j);
          U(k, i) = c * x - s * y;
          U(k, j) = s * x + c * y;
        }
      }
    if (!rotated) break;
  }
}

}  // namespace garrison::certificate::detail
