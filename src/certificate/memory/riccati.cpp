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

Matrix information(const Matrix& C, const Vector& R) {
  return C.transpose() * R.cwiseInverse().asDiagonal() * C;
}

/// P of what was found, if it is the solution.
std::optional<Matrix> solution(const std::optional<Doubled>& found, const Matrix& A, const Matrix& C,
                               const Matrix& Q, const Vector& R) {
  if (!found || !found->settled) return {};
  const Matrix& P = found->P;
  const Matrix I = Matrix::Identity(A.rows(), A.rows());
  const Matrix S = C * P * C.transpose() + Matrix(R.asDiagonal());
  const Matrix closed = A * (I - P * C.transpose() * Eigen::LLT<Matrix>(S).solve(C));
  if (!closed.allFinite()) return {};
  if (!(spectral_radius(closed) < 1.0 - 1e-9)) return {};
  const Matrix next = closed * P * A.transpose() + Q;
  if (!((next - P).cwiseAbs().maxCoeff() <= 1e-6 * P.cwiseAbs().maxCoeff())) return {};
  return P;
}

/// Whether the deviations of the states differ by so much that their units matter.
bool far_apart(const Vector& deviations) {
  constexpr double kFar = 1e3;
  return deviations.minCoeff() > 0.0 && deviations.maxCoeff() > kFar * deviations.minCoeff();
}

}  // namespace

std::optional<Matrix> steady_covariance(const MatrixRef& A, const MatrixRef& C, const MatrixRef& Q,
                                        const VectorRef& R) {
  const auto found = doubled(A, information(C, R), Q);
  const Vector deviations = found ? Vector(found->P.diagonal().cwiseMax(0.0).cwiseSqrt()) : Vector();
  if (!found || !far_apart(deviations)) return solution(found, A, C, Q, R);
  // Again with states in these units, in which no number is rounding of another.
  const auto D = deviations.asDiagonal();
  const Vector inverse = deviations.cwiseInverse();
  const Matrix A_D = inverse.asDiagonal() * A * D;
  const Matrix C_D = C * D;
  const Matrix Q_D = inverse.asDiagonal() * Q * inverse.asDiagonal();
  const auto scaled = solution(doubled(A_D, information(C_D, R), Q_D), A_D, C_D, Q_D, R);
  if (!scaled) return {};
  return Matrix(D * *scaled * D);
}

}  // namespace garrison::certificate::detail
