// SPDX-License-Identifier: Apache-2.0
#include "riccati.hpp"

#include <cmath>

#include "core/solvers.hpp"
#include "garrison/core/spectrum.hpp"

namespace garrison::certificate::detail {

namespace {

/// Doubling: P after 2^k steps of the Riccati recursion from 0. Whether it has settled, if it stays finite.
struct Doubled {
  Matrix P;
  bool settled = false;
};
std::optional<Doubled> doubled(const Matrix& A, const Matrix& info, const Matrix& Q) {
  const Matrix I = Matrix::Identity(A.rows(), A.rows());
  Matrix F = A.transpose();
  Matrix G = info;
  Doubled found{Q};
  for (int k = 0; k < 80 && !found.settled; ++k) {
    Matrix& P = found.P;
    const Eigen::PartialPivLU<Matrix> lu(Matrix(I + G * P));
    const Matrix WF = lu.solve(F);
    const Matrix WG = lu.solve(G);
    const Matrix more = F.transpose() * P * WF;
    G += F * WG * F.transpose();
    F = F * WF;
    P += 0.5 * (more + more.transpose());
    if (!P.allFinite() || !G.allFinite() || !F.allFinite()) return {};
    found.settled = more.cwiseAbs().maxCoeff() <= 1e-15 * P.cwiseAbs().maxCoeff();
  }
  return found;
}

std::optional<Matrix> in_these_units(const Matrix& A, const Matrix& C, const Matrix& Q, const Vector& R) {
  const auto found = doubled(A, C.transpose() * R.cwiseInverse().asDiagonal() * C, Q);
  if (!found || !found->settled) return {};
  const Matrix& P = found->P;
  const Matrix I = Matrix::Identity(A.rows(), A.rows());
  const Matrix S = C * P * C.transpose() + Matrix(R.asDiagonal());
  const Matrix closed = A * (I - P * C.transpose() * Eigen::LLT<Matrix>(S).solve(C));
  if (!closed.allFinite()) return {};
  if (!(spectral_radius(closed) < 1.0 - 1e-9)) return {};
  const Matrix next = closed * P * A.transpose() + Q;
  if (!((next - P).cwiseAbs().maxCoeff() <= 1e-6 * P.cwiseAbs().maxCoeff())) return {};  // not the solution
  return P;
}

/// Deviations of the states, roughly, where they differ by so much that their units matter; else none.
std::optional<Vector> far_apart(const Matrix& A, const Matrix& C, const Matrix& Q, const Vector& R) {
  constexpr double kFar = 1e3;
  const auto rough = doubled(A, C.transpose() * R.cwiseInverse().asDiagonal() * C, Q);
  if (!rough || !(rough->P.diagonal().minCoeff() > 0.0)) return {};
  const Vector deviations = rough->P.diagonal().cwiseSqrt();
  if (!(deviations.maxCoeff() > kFar * deviations.minCoeff())) return {};
  return deviations;
}

}  // namespace

std::optional<Matrix> steady_covariance(const MatrixRef& A, const MatrixRef& C, const MatrixRef& Q,
                                        const VectorRef& R) {
  const auto units = far_apart(A, C, Q, R);
  if (!units) return in_these_units(A, C, Q, R);
  const auto D = units->asDiagonal();
  const Vector inverse = units->cwiseInverse();
  const auto found =
      in_these_units(inverse.asDiagonal() * A * D, C * D, inverse.asDiagonal() * Q * inverse.asDiagonal(), R);
  if (!found) return {};
  return Matrix(D * *found * D);
}

}  // namespace garrison::certificate::detail
