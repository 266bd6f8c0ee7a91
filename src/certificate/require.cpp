// SPDX-License-Identifier: Apache-2.0
#include "require.hpp"

#include "core/spectrum.hpp"

namespace garrison::certificate::detail {

void require_covariance(const char* which, const MatrixRef& P, Eigen::Index size) {
  require_shape(which, P, size, size);
  const double scale = P.cwiseAbs().maxCoeff();
  if (scale == 0.0) return;
  const Matrix scaled = P / scale;
  if ((scaled - scaled.transpose()).cwiseAbs().maxCoeff() > 1e-9)
    refuse(which, "a matrix that is not symmetric", "a covariance");
  const double least = garrison::detail::least_eigenvalue(scaled);
  if (least < -1e-9) refuse(which, "an eigenvalue " + text(least * scale), "a positive semidefinite matrix");
}

}  // namespace garrison::certificate::detail
