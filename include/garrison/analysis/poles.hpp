// SPDX-License-Identifier: Apache-2.0
// Gains of observers by their poles.
#pragma once

#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// H with eig(A - H C) = poles. A: n x n. C: m x n, (A, C) observable. poles: n real numbers.
///
/// One output: Ackermann's formula; H is unique. Several: eigenvectors chosen as far from each other as the
/// poles allow (Kautsky, Nichols and Van Dooren 1985, method 0), of all H with these the one of least norm.
/// @throws InvalidInput on shapes that do not fit, or when a pole is asked for more often than rank C times
/// (with one output it may be)
GARRISON_EXPORT Matrix place_poles(const MatrixRef& A, const MatrixRef& C, const std::vector<double>& poles);

}  // namespace garrison
