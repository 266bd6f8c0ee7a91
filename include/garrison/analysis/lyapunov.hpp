// SPDX-License-Identifier: Apache-2.0
// Steady covariances of linear recursions.
#pragma once

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// X = M X M' + F by doubling. M, F: n x n, F symmetric.
/// @throws InvalidInput when the spectral radius of M is not below 1.
GARRISON_EXPORT Matrix lyapunov(const MatrixRef& M, const MatrixRef& F);

}  // namespace garrison
