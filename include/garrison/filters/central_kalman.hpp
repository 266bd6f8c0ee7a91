// SPDX-License-Identifier: Apache-2.0
// The central Kalman filter: all measurements in one place, no protection. A baseline, not an agent.
#pragma once

#include "garrison/core/model.hpp"

namespace garrison {

/// Estimates (T+1) x n from measurements T x total_outputs, row r belonging to time r+1; NaN or inf =
/// missing. Starts from x0 with covariance `start_variance` I, finite and >= 0. Needs both covariances of the
/// model's noise; measurement covariances must be diagonal. Square-root form: with p0 = 1e10, R = 1e-4 and
/// two nearly parallel sensors 1e-9 is kept. O((n + m) n^2) per row of m measurements. @throws InvalidInput
GARRISON_EXPORT Matrix central_kalman(const Model& model, const MatrixRef& measurements, const VectorRef& x0,
                                      double start_variance);

}  // namespace garrison
