// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/discretise.hpp"

#include <unsupported/Eigen/MatrixFunctions>

#include "core/solvers.hpp"
#include "garrison/core/error.hpp"

namespace garrison {
namespace {

std::string shape(const Matrix& m) { return std::to_string(m.rows()) + " x " + std::to_string(m.cols()); }

void require(const Matrix& F, const Matrix& intensity, double period) {
  const auto n = F.rows();
  if (n < 1 || F.cols() != n) refuse("A", shape(F), "a square matrix");
  if (!F.allFinite()) refuse("A", "a number that is not finite", "finite numbers");
  if (intensity.rows() != n || intensity.cols() != n)
    refuse("process_intensity", shape(intensity), std::to_string(n) + " x " + std::to_string(n));
  if (!intensity.allFinite()) refuse("process_intensity", "a number that is not finite", "finite numbers");
  const double size = intensity.cwiseAbs().maxCoeff();
  if ((intensity - intensity.transpose()).cwiseAbs().maxCoeff() > 1e-9 * size)
    refuse("process_intensity", "a matrix that is not symmetric", "a symmetric one");
  const double least =
      Eigen::SelfAdjointEigenSolver<Matrix>(intensity, Eigen::EigenvaluesOnly).eigenvalues()(0);
  if (least < -1e-9 * size)
    refuse("process_intensity", "an eigenvalue of " + text(least), "a positive semidefinite matrix");
  if (!(period > 0.0) || !std::isfinite(period)) refuse("period", text(period), "a finite number > 0");
}

}  // namespace

Discretised discretise(const Matrix& F, const Matrix& intensity, double period) {
  require(F, intensity, period);
  const auto n = F.rows();
  // exp([-F Q; 0 F'] T) = [.. A^-1 covariance; 0 A'].
  Matrix block = Matrix::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = -F * period;
  block.topRightCorner(n, n) = 0.5 * (intensity + intensity.transpose()) * period;
  block.bottomRightCorner(n, n) = F.transpose() * period;
  const Matrix e = block.exp();
  if (!e.allFinite())
    refuse("period", text(period), "one over which the plant stays finite", "take a shorter one");
  Discretised found;
  found.A = e.bottomRightCorner(n, n).transpose();
  const Matrix covariance = found.A * e.topRightCorner(n, n);
  found.covariance = 0.5 * (covariance + covariance.transpose());
  return found;
}

Matrix held_input(const Matrix& F, const Matrix& G, double period) {
  const auto n = F.rows();
  require(F, Matrix::Zero(n, n), period);
  if (G.size() == 0) return Matrix::Zero(n, 0);
  if (G.rows() != n) refuse("B", shape(G), amount(n, "row") + ", because A is " + shape(F));
  if (!G.allFinite()) refuse("B", "a number that is not finite", "finite numbers");
  Matrix block = Matrix::Zero(n + G.cols(), n + G.cols());
  block.topLeftCorner(n, n) = F * period;
  block.topRightCorner(n, G.cols()) = G * period;
  const Matrix e = block.exp();
  if (!e.allFinite())
    refuse("period", text(period), "one over which the plant stays finite", "take a shorter one");
  return e.topRightCorner(n, G.cols());
}

}  // namespace garrison
