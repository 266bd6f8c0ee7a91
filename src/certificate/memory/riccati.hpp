// SPDX-License-Identifier: Apache-2.0
// Steady covariance of a Kalman filter. Internal.
#pragma once

#include <optional>

#include "garrison/core/types.hpp"

namespace garrison::certificate::detail {

/// P of x+ given all before: P = A P (I + C'R^-1 C P)^-1 A' + Q, by doubling. R: variances of the rows of C.
/// None when the filter does not settle: (A, C) not detectable, or a marginal mode without noise.
std::optional<Matrix> steady_covariance(const MatrixRef& A, const MatrixRef& C, const MatrixRef& Q,
                                        const VectorRef& R);

}  // namespace garrison::certificate::detail
