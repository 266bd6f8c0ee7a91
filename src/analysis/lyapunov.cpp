// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/lyapunov.hpp"

#include <cmath>

#include "core/solvers.hpp"
#include "garrison/core/spectrum.hpp"

namespace garrison {

Matrix lyapunov(const MatrixRef& M, const MatrixRef& F) {
  Matrix power = M;
  Matrix X = F;
  // |M^(2^k)| falls below any size once k > log2(1 / (1 - rho)); 60 doublings reach rho = 1 - 1e-16.
  for (int k = 0; k < 60; ++k) {
    const Matrix more = power * X * power.transpose();
    X += more;
    const double size = X.cwiseAbs().maxCoeff();
    if (!std::isfinite(size)) break;
    if (more.cwiseAbs().maxCoeff() <= 1e-18 * size) return 0.5 * (X + X.transpose());
    power = power * power;
  }
  refuse("spectral radius of the error matrix", text(spectral_radius(M)), "below 1 (Schur stable)",
         "there is no steady state");
}

}  // namespace garrison
