// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/observer_table.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "../require.hpp"
#include "../top.hpp"

namespace garrison::certificate {
namespace {

/// What a lag does to the coordinates, the 2-norm and C_r A e: rows in this order.
struct Lag {
  Matrix L;         // functionals x m
  Vector w, start;  // functionals
};

struct Observer {
  const MatrixRef &A, &C, &L, &Gam;
  Matrix CA, F, B_w;

  Observer(const MatrixRef& a, const MatrixRef& c, const MatrixRef& l, const MatrixRef& gam)
      : A(a), C(c), L(l), Gam(gam), CA(c * a) {
    const Matrix open = Matrix::Identity(A.rows(), A.rows()) - L * C;
    F = open * A;
    B_w = -open * Gam;
  }
  Eigen::Index n() const { return A.rows(); }
  Eigen::Index functionals() const { return n() + 1 + C.rows(); }

  Lag lag(const Matrix& X) const {
    Lag k{Matrix(functionals(), C.rows()), Vector(functionals()), Vector(functionals())};
    const Matrix XL = X * L;
    const Matrix XB = X * B_w;
    k.L << XL.cwiseAbs(), XL.colwise().norm(), (CA * XL).cwiseAbs();
    k.w << XB.rowwise().norm(), spectral_norm(XB), (CA * XB).rowwise().norm();
    k.start << X.rowwise().norm(), spectral_norm(X), (CA * X).rowwise().norm();
    return k;
  }
};

}  // namespace

ObserverTable observer_table(const MatrixRef& A, const MatrixRef& C, const MatrixRef& L, const MatrixRef& Gam,
                             const VectorRef& bv, std::span<const int> source, const ObserverOptions& o) {
  const Eigen::Index n = A.rows();
  const Eigen::Index m = C.rows();
  if (n < 1 || m < 1) refuse("A, C", detail::shape(A) + " and " + detail::shape(C), "at least 1 x 1");
  detail::require_shape("A", A, n, n);
  detail::require_shape("C", C, m, n);
  detail::require_shape("L", L, n, m);
  detail::require_shape("Gam", Gam, n, Gam.cols());
  detail::require_bounds("bv", bv, m);
  detail::require_least("s", o.s, 0);
  detail::require_least("bw", o.bw, 0.0);
  detail::require_least("start", o.start, 0.0);
  detail::require_least("T", o.T, 1);
  detail::require_least("lags", o.lags, 1);
  if (!source.empty() && static_cast<Eigen::Index>(source.size()) != m)
    refuse("source", std::to_string(source.size()), amount(m, "number"), "one per row");
  std::vector<int> of(static_cast<std::size_t>(m));
  for (std::size_t r = 0; r < of.size(); ++r) {
    of[r] = source.empty() ? static_cast<int>(r) : source[r];
    if (of[r] < 0 || of[r] >= static_cast<int>(m))
      refuse("source", std::to_string(of[r]), "0.." + std::to_string(m - 1));
  }
  const Observer x(A, C, L, Gam);
  const double width = static_cast<double>(x.functionals());
  detail::require_room("T, lags",
                       (o.T + 1.0) * 3.0 * width + (o.lags + 1.0) * width * (static_cast<double>(m) + 2.0));

  std::vector<Lag> lags;
  Matrix X = Matrix::Identity(n, n);
  for (int k = 0; k <= o.lags; ++k) {
    if (!X.allFinite())
      refuse("lags", std::to_string(o.lags), "powers of (I - L C) A that are finite", "take less");
    lags.push_back(x.lag(X));
    X = x.F * X;
  }
  const Vector own = (C * Gam).rowwise().norm() * o.bw;
  ObserverTable t{Gains::Constant(o.T + 1, n + 1, kInfinity), Gains::Constant(o.T + 1, m, kInfinity),
                  Gains::Constant(o.T + 1, m, kInfinity)};
  t.d.row(0).setConstant(o.start);
  t.eta.row(0) = o.start * x.CA.rowwise().norm().transpose();
  t.level.row(0).setZero();
  Gains theta = Gains::Zero(o.T + 1, m);  // how far an attacked row may push beyond its own noise
  std::vector<double> by_source(static_cast<std::size_t>(m));
  Vector sum(x.functionals());
  for (int step = 1; step <= o.T; ++step) {
    const auto H0 = (t.eta.row(step - 1).transpose() + own).eval();
    t.level.row(step) = (H0 + bv).transpose();
    theta.row(step) = 2.0 * H0.transpose();
    const int most = std::min(step, o.lags);
    sum = lags[static_cast<std::size_t>(most)].start * t.d(step - most, n);
    for (int k = 0; k < most; ++k) {
      const Lag& lag = lags[static_cast<std::size_t>(k)];
      sum += lag.w * o.bw + lag.L * bv;
      for (Eigen::Index i = 0; i < sum.size(); ++i) {
        std::fill(by_source.begin(), by_source.end(), 0.0);
        for (Eigen::Index r = 0; r < m; ++r)
          by_source[static_cast<std::size_t>(of[static_cast<std::size_t>(r)])] +=
              lag.L(i, r) * theta(step - k, r);
        sum(i) += detail::top(by_source, o.s);
      }
    }
    if (!sum.allFinite() || sum(n) > 1e12) break;
    t.d.row(step) = sum.head(n + 1).transpose();
    t.eta.row(step) = sum.tail(m).transpose();
  }
  return t;
}

}  // namespace garrison::certificate
