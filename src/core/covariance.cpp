// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/covariance.hpp"

#include "core/spectrum.hpp"
#include "garrison/core/error.hpp"

namespace garrison {

void require_covariance(const std::string& which, const Matrix& S) {
  if (S.size() == 0) return;
  if (!S.isApprox(S.transpose(), 1e-12))
    refuse(which, "a matrix that is not symmetric", "a symmetric one", "use (M + M') / 2");
  const double least = detail::least_eigenvalue(S);
  if (least < -1e-12 * S.cwiseAbs().maxCoeff())
    refuse(which, "least eigenvalue " + text(least), "a positive semidefinite covariance", "check its sign");
}

}  // namespace garrison
