// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/coordinates.hpp"

#include <cmath>
#include <string>

#include "core/solvers.hpp"

namespace garrison::saturation {
namespace {

/// T is refused, and a direction counts as not measured, below this ratio of extreme singular values.
constexpr double kSingular = 1e-13;

/// A and C of a plant with at least one state and one sensor.
void require_plant(MatrixRef A, MatrixRef C) {
  if (A.rows() < 1) refuse("A", "0 rows", "a square matrix with at least one row");
  if (C.rows() < 1) refuse("C", "0 rows", "one row per sensor, at least one");
}

void require_shape(const char* which, MatrixRef M, Eigen::Index rows, Eigen::Index columns) {
  const auto shape = [](Eigen::Index r, Eigen::Index c) {
    return std::to_string(r) + " x " + std::to_string(c);
  };
  if (M.rows() != rows || M.cols() != columns)
    refuse(which, shape(M.rows(), M.cols()), shape(rows, columns), "check the sizes of A, C and T");
  if (!M.allFinite()) refuse(which, "a number that is not finite", "finite numbers");
}

}  // namespace

UnitRows normalise_rows(MatrixRef C, VectorRef b_v) {
  require_shape("C", C, C.rows(), C.cols());
  if (b_v.size() != C.rows())
    refuse("b_v", amount(b_v.size(), "number"), std::to_string(C.rows()), "give one per row of C");
  for (Eigen::Index i = 0; i < b_v.size(); ++i)
    if (!std::isfinite(b_v[i]) || b_v[i] < 0.0)
      refuse("b_v[" + std::to_string(i) + "]", text(b_v[i]), "a finite number >= 0");
  UnitRows unit{C, b_v, Vector(C.rows())};
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    const double length = C.row(i).stableNorm();
    if (length == 0.0)
      refuse("C[" + std::to_string(i) + "]", "a zero row", "a row of positive length",
             "leave this sensor out, it sees nothing of the state");
    unit.scale[i] = 1.0 / length;
    unit.C.row(i) /= length;
    unit.b_v[i] /= length;
  }
  return unit;
}

Coordinates transform(MatrixRef A, MatrixRef C, double b_w, VectorRef b_v, MatrixRef T) {
  require_plant(A, C);
  const Eigen::Index n = A.rows();
  require_shape("A", A, n, n);
  require_shape("C", C, C.rows(), n);
  require_shape("T", T, n, n);
  if (!std::isfinite(b_w) || b_w < 0.0) refuse("b_w", text(b_w), "a finite number >= 0");
  const Eigen::JacobiSVD<Matrix> svd(T, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector& values = svd.singularValues();
  const double largest = values[0];
  const double smallest = values[n - 1];
  if (!(smallest > kSingular * largest))
    refuse("T", "singular values " + text(smallest) + ".." + text(largest), "an invertible matrix");
  const Matrix inverse = svd.matrixV() * values.cwiseInverse().asDiagonal() * svd.matrixU().transpose();
  return {T,       inverse,       T * A * inverse, normalise_rows(C * inverse, b_v), largest * b_w,
          largest, 1.0 / smallest};
}

Coordinates scale_states(MatrixRef A, MatrixRef C, double b_w, VectorRef b_v, VectorRef tau) {
  for (Eigen::Index k = 0; k < tau.size(); ++k)
    if (!std::isfinite(tau[k]) || tau[k] <= 0.0)
      refuse("tau[" + std::to_string(k) + "]", text(tau[k]), "a finite number > 0");
  return transform(A, C, b_w, b_v, Matrix(tau.asDiagonal()));
}

Coordinates whiten(MatrixRef A, MatrixRef C, double b_w, VectorRef b_v) {
  require_plant(A, C);
  require_shape("C", C, C.rows(), A.cols());
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(Matrix(C.transpose() * C));
  const Vector& values = eigen.eigenvalues();
  const double largest = values[values.size() - 1];
  if (!(values[0] > kSingular * largest))
    refuse("C", "eigenvalues " + text(values[0]) + ".." + text(largest) + " of the sum of C_i'C_i",
           "a positive definite sum", "some direction is measured by no sensor; use scale_states instead");
  return transform(A, C, b_w, b_v, eigen.operatorSqrt());
}

}  // namespace garrison::saturation
