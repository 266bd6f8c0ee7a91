// SPDX-License-Identifier: Apache-2.0
#include "policy_iteration.hpp"

#include <algorithm>
#include <cmath>

#include "core/solvers.hpp"
#include "garrison/core/budget.hpp"

namespace garrison::detail {
namespace {

using Index = Eigen::Index;

constexpr int kMostSteps = 120;
constexpr double kSettled = 1e-13;
/// A step that small, and no smaller than the one before, is where rounding stops it.
constexpr double kRounded = 1e-6;

Vector stacked(const Matrices& D) {
  const Index size = D.front().size();
  Vector v(size * static_cast<Index>(D.size()));
  for (std::size_t i = 0; i < D.size(); ++i) v.segment(static_cast<Index>(i) * size, size) = D[i].reshaped();
  return v;
}

Matrices unstacked(const Vector& v, std::size_t count, Index n) {
  Matrices D;
  for (std::size_t i = 0; i < count; ++i) {
    const Matrix one = v.segment(static_cast<Index>(i) * n * n, n * n).reshaped(n, n);
    D.push_back(0.5 * (one + one.transpose()));
  }
  return D;
}

/// Solves (I - L) x = b (Saad, Schultz 1986) for b whose squares neither overflow nor vanish; returns the
/// relative residual reached.
double gmres_of_size_one(const RiccatiMap& map, const Vector& b, std::size_t count, Index n, Vector& x) {
  constexpr Index kBasis = 80;
  constexpr int kRestarts = 20;
  constexpr double kGoal = 1e-12;
  const auto apply = [&](const Vector& v) { return Vector(v - stacked(map.apply(unstacked(v, count, n)))); };
  x = Vector::Zero(b.size());
  const double size = b.norm();
  if (size == 0.0) return 0.0;
  double left = 1.0;
  for (int restart = 0; restart < kRestarts; ++restart) {
    const Vector r = b - apply(x);
    const double before = r.norm() / size;
    if (!(before > kGoal) || (restart > 0 && !(before < 0.9 * left))) return before;
    left = before;
    const Index most = std::min(kBasis, b.size());
    Matrix V(b.size(), most + 1);
    Matrix H = Matrix::Zero(most + 1, most);
    V.col(0) = r.normalized();
    Index m = 0;
    for (bool full = false; m < most && !full; ++m) {
      require_time("the solution of coupled Riccati equations");
      Vector w = apply(V.col(m));
      const double whole = w.norm();
      for (int twice = 0; twice < 2; ++twice) {
        const Vector h = V.leftCols(m + 1).transpose() * w;
        w -= V.leftCols(m + 1) * h;
        H.col(m).head(m + 1) += h;
      }
      H(m + 1, m) = w.norm();
      full = !(H(m + 1, m) > 1e-14 * whole);
      if (!full) V.col(m + 1) = w / H(m + 1, m);
    }
    const Vector goal = Vector::Unit(m + 1, 0) * r.norm();
    const Matrix small = H.topLeftCorner(m + 1, m);
    x += V.leftCols(m) *
         Eigen::JacobiSVD<Matrix>(small, Eigen::ComputeThinU | Eigen::ComputeThinV).solve(goal);
  }
  return (b - apply(x)).norm() / size;
}

/// The same for any finite b.
double gmres(const RiccatiMap& map, const Vector& b, std::size_t count, Index n, Vector& x) {
  const double size = b.cwiseAbs().maxCoeff();
  const double left = gmres_of_size_one(map, size > 0.0 ? Vector(b / size) : b, count, n, x);
  x *= size;
  return left;
}

double relative_change(const Matrices& D, const Matrices& P) {
  double change = 0.0;
  for (std::size_t i = 0; i < P.size(); ++i) {
    const double size = P[i].cwiseAbs().maxCoeff();
    if (size > 0.0) change = std::max(change, D[i].cwiseAbs().maxCoeff() / size);
  }
  return change;
}

}  // namespace

FixedPoint policy_iteration(RiccatiMap& map, Matrices start) {
  constexpr double kSolved = 1e-2;  // Newton corrects what is left in its next step
  FixedPoint out;
  out.P = std::move(start);
  const Index n = out.P.front().rows();
  double before = kInfinity;
  for (out.steps = 1; out.steps <= kMostSteps; ++out.steps) {
    const Vector r = stacked(map.residual(out.P));
    Vector x;
    if (!r.allFinite() || !(gmres(map, r, out.P.size(), n, x) < kSolved)) return out;
    const Matrices D = unstacked(x, out.P.size(), n);
    for (std::size_t i = 0; i < D.size(); ++i) {
      out.P[i] += D[i];
      if (!(out.P[i].diagonal().minCoeff() >= 0.0))
        return out;  // left the cone: the start was no upper bound
    }
    out.change = relative_change(D, out.P);
    out.converged = out.change <= kSettled || (out.change < kRounded && out.change >= 0.5 * before);
    if (out.converged) return out;
    before = out.change;
  }
  return out;
}

}  // namespace garrison::detail
