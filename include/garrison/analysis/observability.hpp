// SPDX-License-Identifier: Apache-2.0
// Observability when some sensors are taken away (definition 1 of the saturation paper).
#pragma once

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// Every mode of A is seen (visibility(A, C, 0) in modes.hpp): rank [C; CA; ...; CA^(n-1)] = n.
/// A: n x n. C: m x n, m >= 0. @throws InvalidInput on shapes that do not fit, and where one cannot tell
GARRISON_EXPORT bool observable(const MatrixRef& A, const MatrixRef& C);

/// The same, false where one cannot tell.
GARRISON_EXPORT bool surely_observable(const MatrixRef& A, const MatrixRef& C);

/// Sets of removed rows that s_sparse_observable tries at most before it refuses.
inline constexpr double kMostRemovals = 2e6;

/// (A, kept rows) is observable for every choice of N - s kept rows of C (N x n). Equal rows are
/// interchangeable; mode by mode, only rows are tried whose loss can cost rank.
/// @throws InvalidInput when s is outside 0..N, more than kMostRemovals choices would have to be tried, or no
/// choice is unobservable and one cannot tell of some
GARRISON_EXPORT bool s_sparse_observable(const MatrixRef& A, const MatrixRef& C, int s);

/// lambda_0(s) > 1e-9: every N - s rows span the state in one step.
GARRISON_EXPORT bool one_step_sparse_observable(const MatrixRef& C, int s);

}  // namespace garrison
