// SPDX-License-Identifier: Apache-2.0
#include "riccati.hpp"

#include <cmath>

#include "core/solvers.hpp"
#include "garrison/core/spectrum.hpp"

namespace garrison::certificate::detail {

std::optional<Matrix> steady_covariance(const MatrixRef& A, const MatrixRef& C, const MatrixRef& Q,
                                        const VectorRef& R) {
  const Eigen::Index n = A.rows();
  const Matrix I = Matrix::Identity(n, n);
  const Matrix info = C.transpose() * R.cwiseInverse().asDiagonal() * C;
  Matrix F = A.transpose();
  Matrix G = info;
  Matrix P = Q;
  bool settled = false;
  for (int k = 0; k < 80 && !settled; ++k) {
    const Eigen::PartialPivLU<Matrix> lu(Matrix(I + G * P));
    const Matrix WF = lu.solve(F);
    const Matrix WG = lu.solve(G);
    const Matrix more = F.transpose() * P * WF;
    G += F * WG * F.transpose();
    F = F * WF;
    P += 0.5 * (more + more.transpose());
    if (!P.allFinite() || !G.allFinite() || !F.allFinite()) return {};
    settled = more.cwiseAbs().maxCoeff() <= 1e-15 * P.cwiseAbs().maxCoeff();
  }
  if (!settled) return {};
  const Matrix S = C * P * C.transpose() + Matrix(R.asDiagonal());
  const Matrix closed = A * (I - P * C.transpose() * Eigen::LLT<Matrix>(S).solve(C));
  if (!closed.allFinite()) return {};
  if (!(spectral_radius(closed) < 1.0 - 1e-9)) return {};
  const Matrix next = closed * P * A.transpose() + Q;
  if (!((next - P).cwiseAbs().maxCoeff() <= 1e-6 * P.cwiseAbs().maxCoeff())) return {};  // not the solution
  return P;
}

}  // namespace garrison::certificate::detail
