// SPDX-License-Identifier: Apache-2.0
// A plant given by differential equations, as what it is from sample to sample.
#pragma once

#include "garrison/core/abi.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// x(t + period) = A x(t) + w with w of this covariance.
struct GARRISON_EXPORT Discretised {
  Matrix A;           ///< e^(F period)
  Matrix covariance;  ///< integral over 0..period of e^(F s) intensity e^(F' s) ds; symmetric
};

/// Of dx/dt = F x + white noise of spectral density `intensity` (n x n, symmetric positive semidefinite, unit
/// state^2 per time), exactly (C. F. Van Loan, IEEE TAC 23 (3), 1978), from one exponential of size 2 n.
/// `period` > 0 in the unit of time of F. @throws InvalidInput when something does not fit or overflows
GARRISON_EXPORT Discretised discretise(const Matrix& F, const Matrix& intensity, double period);

/// What multiplies an input that is held over a period: integral over 0..period of e^(F s) ds G, exactly,
/// from one exponential. G: n x p. @throws InvalidInput
GARRISON_EXPORT Matrix held_input(const Matrix& F, const Matrix& G, double period);

}  // namespace garrison
