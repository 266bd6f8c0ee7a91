// SPDX-License-Identifier: Apache-2.0
// A model with every station as a state: vector autoregression with known inputs, its order by held-out
// likelihood.
#pragma once

#include <vector>

#include "garrison/analysis/identify.hpp"
#include "garrison/core/abi.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// How long a past to look at.
struct AutoregressionOptions {
  int order = 0;  ///< 1..most: this one; 0: the one in 1..most under which held-out samples are likeliest
  int most = 4;   ///< largest order that is tried, >= 1
  double held_out = 0.25;  ///< share of the samples, the last ones, that choose the order; in (0, 0.9]
};

/// z(t) = A_1 z(t-1) + .. + A_p z(t-p) + B u + e. State of the model: z(t), z(t-1), .., z(t-p+1), n = N p.
struct GARRISON_EXPORT Autoregression {
  int order = 1;                 ///< p
  Matrix A;                      ///< n x n, the companion form
  Matrix B;                      ///< n x inputs, zero but for the first N rows
  Matrix residual_covariance;    ///< N x N, of e
  double residual_bound = kNaN;  ///< largest ||e|| of the records
  Matrix residuals;              ///< T x N, NaN where the past is not complete
  std::vector<double> held_out;  ///< mean log-likelihood of a held-out sample under orders 1..most
  int samples = 0;               ///< with a complete past, on which it rests
};

/// Least squares. `z`: T x N without mean and season, NaN = missing; `u`: T x inputs, row t what led to row t
/// (T x 0: none). Samples with a gap in their past are left out. Orders are compared on the same samples,
/// each fitted to what comes before them; the chosen one is fitted to all. @throws InvalidInput on wrong
/// options, fewer than 10 complete samples per regressor, or regressors that depend on each other
GARRISON_EXPORT Autoregression autoregress(const MatrixRef& z, const MatrixRef& u,
                                           const AutoregressionOptions& options);

/// The model of all stations as `identify` gives one of factors: unit rows of z(t), measurements in the
/// records' unit. What stations measure is the state itself, so the records cannot tell measurement noise
/// from process noise: it is taken to be `noise`, in (0, 1), of each station's residual variance, and has no
/// bound.
GARRISON_EXPORT Identified identified(const Autoregression& found, const Matrix& season,
                                      const FitOptions& options, double noise);

}  // namespace garrison
