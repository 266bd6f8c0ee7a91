// SPDX-License-Identifier: Apache-2.0
// The largest eigenvalue of a symmetric operator that is known by its products only.
#pragma once

#include <functional>

#include "garrison/core/types.hpp"

namespace garrison::detail {

struct Ritz {
  double value = 0.0;
  bool settled = false;  ///< the residual of its vector is at most `accuracy` times the value
};

/// Estimate of the largest eigenvalue on the space orthogonal to the all-ones vector, by Lanczos with full
/// reorthogonalisation, at most `most` products. Its error is about the square of the residual over the
/// distance to the next eigenvalue. Ends unsettled where it is clear that the eigenvalue is above `enough`.
/// @throws InvalidInput when the budget is over
Ritz largest_eigenvalue(Eigen::Index size, double accuracy, int most,
                        const std::function<Vector(const Vector&)>& apply, double enough = kInfinity);

}  // namespace garrison::detail
