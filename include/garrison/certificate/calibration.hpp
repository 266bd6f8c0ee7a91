// SPDX-License-Identifier: Apache-2.0
// What clean records say of levels that were set from a model: rates that were asked for against rates got.
#pragma once

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// A level that a share `delta` of clean values exceeds, and where the true one is with the confidence asked
/// for.
struct Quantile {
  double value = kNaN;  ///< the ceil((T+1)(1-delta))-th smallest; NaN when T is too small for it
  double lower =
      kNaN;  ///< order statistics around it, exact for independent values of any law; NaN where none
  double upper = kNaN;  ///< of the sample is far enough out
  int values = 0;       ///< T, those that are not NaN
};
/// delta and 1 - confidence in (0, 1). @throws InvalidInput
GARRISON_EXPORT Quantile empirical_quantile(const VectorRef& values, double delta, double confidence);

/// Ljung-Box test of residuals against "each is independent of its past", sensor by sensor.
struct Whiteness {
  Vector statistic;    ///< N: T(T+2) sum over lags of r_k^2/(T-k); chi-square with `lags` degrees when white
  Vector correlation;  ///< N: r_1
  double p_value = kNaN;  ///< of the worst sensor, times N (Bonferroni): small = not white
};
/// residuals: T x N, NaN and infinity = missing (pairs with one are left out); lags in 1..T-1. @throws
/// InvalidInput
GARRISON_EXPORT Whiteness whiteness(const MatrixRef& residuals, int lags);

}  // namespace garrison::certificate
