// SPDX-License-Identifier: Apache-2.0
// Eigenvalues of dense matrices by the question that is asked: compiled once.
#pragma once

#include "garrison/core/spectrum.hpp"

namespace garrison::detail {

/// Least eigenvalue of the symmetric matrix S, n >= 1.
double least_eigenvalue(const MatrixRef& S);

/// L with L L' = P, from the eigenvalues: P may be singular, and its zeros of either sign by rounding. Those
/// of P scaled to variances of 1: states have units, and what is rounding beside one is all there is of
/// another.
Matrix covariance_root(const MatrixRef& P);

}  // namespace garrison::detail
