// SPDX-License-Identifier: Apache-2.0
// The pencil [A - z I; C] of a balanced pair at one z, and where its least singular value is small. Internal.
#pragma once

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/solvers.hpp"
#include "garrison/core/types.hpp"
#include "garrison/kernel/hypotenuse.hpp"

namespace garrison::detail {

using Complex = std::complex<double>;
template <class S>
using MatrixOf = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic>;
template <class S>
using VectorOf = Eigen::Matrix<S, Eigen::Dynamic, 1>;

template <class S>
S scalar_of(Complex z) {
  if constexpr (std::is_same_v<S, double>)
    return z.real();
  else
    return z;
}

/// States up to which the search for the nearest unseen mode is thorough; beyond, a decomposition more costs
/// seconds, and only modes that may decide the answer are refined.
inline constexpr Eigen::Index kThorough = 100;

/// Candidates for z: the eigenvalues of A, and the means of their clusters (a k-fold eigenvalue is
/// computed with errors of eps^(1/k), the mean of its copies with eps). With `least` > 0, those far inside
/// of that circle are left out and the others are moved out to it. `balanced`: D^-1 A D, whose eigenvalues
/// are computed unless A is symmetric.
std::vector<Complex> candidate_modes(const Matrix& A, const Matrix& balanced, double rate, double least);

/// z, moved radially out to the circle of radius `least` where it is inside.
Complex outside(Complex z, double least);

/// An upper bound of the spectral norm of [A; C], close to it for sparse ones; 1 for zeros.
template <class M>
double pair_size(const M& A, const M& C) {
  const double rows = std::max(A.rowwise().template lpNorm<1>().maxCoeff(),
                               C.rows() > 0 ? C.rowwise().template lpNorm<1>().maxCoeff() : 0.0);
  const Vector column_sums =
      A.cwiseAbs().colwise().sum().transpose() + C.cwiseAbs().colwise().sum().transpose();
  const double size = std::min(hypotenuse(A.norm(), C.norm()), std::sqrt(rows * column_sums.maxCoeff()));
  return size > 0.0 ? size : 1.0;
}

/// R of the QR decomposition of [A - z I; C].
template <class S>
MatrixOf<S> triangle(const MatrixOf<S>& A, const MatrixOf<S>& C, S z) {
  const Eigen::Index n = A.rows();
  MatrixOf<S> pencil(n + C.rows(), n);
  pencil.topRows(n) = A;
  pencil.topRows(n).diagonal().array() -= z;
  pencil.bottomRows(C.rows()) = C;
  const Eigen::HouseholderQR<MatrixOf<S>> qr(pencil);
  return qr.matrixQR().topRows(n).template triangularView<Eigen::Upper>();
}

/// Least singular value of a triangle and its right vector, by inverse iteration; never below the true one by
/// more than rounding.
template <class S>
double least_singular(MatrixOf<S> R, VectorOf<S>& v) {
  const Eigen::Index n = R.rows();
  const MatrixOf<S> exact = R;
  const double tiny = 1e-3 * 2.2e-16 * std::max(R.cwiseAbs().maxCoeff(), 1e-290);
  for (Eigen::Index k = 0; k < n; ++k)
    if (std::abs(R(k, k)) < tiny) R(k, k) = S(tiny);
  v = VectorOf<S>::NullaryExpr(n, [](Eigen::Index k) { return S(1.0 + 0.37 * std::sin(1.7 * double(k))); });
  v.normalize();
  double best = (exact * v).norm();
  for (int k = 0; k < 12; ++k) {
    VectorOf<S> next = R.adjoint().template triangularView<Eigen::Lower>().solve(v);
    next /= next.cwiseAbs().maxCoeff();
    next = R.template triangularView<Eigen::Upper>().solve(next).eval();
    next.normalize();
    if (!next.allFinite()) break;
    const double value = (exact * next).norm();
    if (value < best) v = next;
    if (!(value < 0.99 * best)) break;
    best = value;
  }
  return (exact * v).norm();
}

}  // namespace garrison::detail
