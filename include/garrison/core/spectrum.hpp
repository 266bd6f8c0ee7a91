// SPDX-License-Identifier: Apache-2.0
// How fast a linear recursion grows.
#pragma once

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// Largest modulus of an eigenvalue of M (n x n, n = 0: 0): by dense QR.
GARRISON_EXPORT double spectral_radius(const MatrixRef& M);

}  // namespace garrison
