// SPDX-License-Identifier: Apache-2.0
// From clean records of a sensor network to a model: seasonal cycle, factors, A, C, noise.
#pragma once

#include <optional>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// How to read the records.
struct FitOptions {
  int factors = 2;         ///< n: common factors that become the state, 1..N
  int harmonics = 2;       ///< sine-cosine pairs of the seasonal cycle, >= 0 (0 = mean only)
  double period = 365.25;  ///< of the cycle, in samples, > 0
  bool root = false;       ///< work on the square root (right for speeds and counts); records must be >= 0
  double factor = 1.0;     ///< records are multiplied by it first (a unit conversion), > 0
  /// Factors of the stations' deviations, each in units of its own standard deviation: they do not depend on
  /// the units of the columns. false: as the records are, whose unit must be one. Left out: false, where
  /// their sizes are comparable.
  std::optional<bool> standardise;
};

/// The identified model, and the fixed map from raw records to measurements.
struct GARRISON_EXPORT Identified {
  FitOptions options;
  Matrix season;  ///< (1 + 2 harmonics) x N: mean, then cosine and sine of each harmonic
  Vector scale;   ///< N: an anomaly divided by it is the measurement y_i, whose row C_i has unit length
  Vector weight;  ///< N: of y_i in the least squares that say what the state was
  Matrix A;       ///< n x n
  Matrix C;       ///< N x n, rows of unit length
  Vector share;   ///< n: part of the anomalies' variance that each factor carries, 0..1
  Matrix process_covariance;    ///< n x n, of x(t+1) - A x(t)
  Vector measurement_variance;  ///< N, of y_i - C_i x
  double process_bound = kNaN;  ///< largest ||x(t+1) - A x(t)|| of the records
  Vector measurement_bound;     ///< N, largest |y_i - C_i x| of the records
};

/// Fits by least squares. `raw`: T x N records, NaN = missing; row r is sample `first + r` of the seasonal
/// clock. The state at a time is what the leading principal directions of the anomalies say of all records of
/// that time (divided by sqrt(N), so that an anomaly, in its unit, and its measurement have about the same
/// size).
/// @throws InvalidInput on wrong options, fewer than 10 n complete rows, a constant or empty column, a
/// negative record with `root`, columns whose sizes differ by more than 100 where nothing is said of them
GARRISON_EXPORT Identified identify(const MatrixRef& raw, std::int64_t first, const FitOptions& options);

/// Records without their seasonal cycle, T x N, which is written to `season` as Identified keeps it. @throws
/// InvalidInput
GARRISON_EXPORT Matrix anomalies(const MatrixRef& raw, std::int64_t first, const FitOptions& options,
                                 Matrix& season);

/// Measurements (T x N) of other records under a fixed model.
GARRISON_EXPORT Matrix measurements(const Identified& model, const MatrixRef& raw, std::int64_t first);

/// What we call truth on real data: the least-squares state (T x n) of CLEAN measurements of the same time,
/// all stations together; NaN where too few are present. It uses no past and no filter.
GARRISON_EXPORT Matrix reference_states(const Identified& model, const MatrixRef& measured);

}  // namespace garrison
