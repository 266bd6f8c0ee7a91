// SPDX-License-Identifier: Apache-2.0
// Levels that noise exceeds with a given probability: Gaussian, sub-Gaussian and from clean records.
#pragma once

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// z with P(|N(0,1)| > z) = delta, to 1e-14 relative. delta in (0, 1). @throws InvalidInput
GARRISON_EXPORT double two_sided(double delta);

/// c with P(chi-square with `degrees` degrees > c^2) = delta: the length that a standard Gaussian vector of
/// that dimension exceeds. delta in (0, 1), degrees >= 1; to 1e-12 relative. @throws InvalidInput
GARRISON_EXPORT double chi(double delta, int degrees);

/// P(chi-square with `degrees` degrees > square). degrees >= 1, square >= 0. @throws InvalidInput
GARRISON_EXPORT double chi_square_tail(double square, int degrees);

/// The same as two_sided and chi for noise of which only a sub-Gaussian proxy variance is known: not less
/// than the true levels (Hsu, Kakade and Zhang 2012 for the length of a vector). @throws InvalidInput
GARRISON_EXPORT double sub_gaussian_two_sided(double delta);
GARRISON_EXPORT double sub_gaussian_chi(double delta, int degrees);

/// What the witnesses take: z1 for every single measurement, z2 for the least-squares vector.
struct Levels {
  double z1 = kNaN;
  double z2 = kNaN;
};

/// Gaussian levels that fail together with probability <= delta: half for `rows` measurements, half for the
/// vector of `states` numbers. @throws InvalidInput
GARRISON_EXPORT Levels gaussian_levels(double delta, int rows, int states);
GARRISON_EXPORT Levels sub_gaussian_levels(double delta, int rows, int states);

/// Distribution-free levels for one state and rows C = +-1 (split conformal): each the
/// ceil((T+1)(1-delta/2))-th smallest of the samples' largest |v_j|/sigma_j and of their largest
/// least-squares statistic over all sets with at most s sensors missing. Exact for exchangeable samples, also
/// when the attacked sensors are chosen with knowledge of the noise. V: T x N clean residuals, times C. R: N
/// variances > 0. s in 0..N-1. delta >= 2/(T+1).
/// @throws InvalidInput also when more than 2e8 sums would be needed
GARRISON_EXPORT Levels calibrated_levels(const MatrixRef& V, const VectorRef& R, int s, double delta);

}  // namespace garrison::certificate
