// SPDX-License-Identifier: Apache-2.0
// Kalman filters that see measurements as they come, in one place or per agent, unprotected, gated or robust.
// Baselines, not agents.
#pragma once

#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/series.hpp"

namespace garrison {

/// What protects a Kalman filter from outliers; at most one of them.
struct Screen {
  double gate = 0.0;         ///< probability in (0, 1) that an honest output is left out; 0: none is
  double huber = kInfinity;  ///< > 0, deviations from which on a residual's pull stays the same; inf: never
};

/// What is known besides the model's constant part.
struct Known {
  Matrix inputs = {};  ///< T x Model::inputs(): row t is u(t), which leads from time t to t + 1
  Series series = {};  ///< what changes in time
};

/// Estimates (T+1) x n from measurements T x total_outputs, row r belonging to time r+1; NaN or inf =
/// missing. Starts from x0 with covariance `start_variance` I, finite and >= 0. Needs both covariances of the
/// model's noise; measurement covariances must be diagonal. Square-root form: with p0 = 1e10, R = 1e-4 and
/// two nearly parallel sensors 1e-9 is kept. O((n + m) n^2) per row of m measurements. @throws InvalidInput
///
/// screen.gate: an output whose squared innovation, divided by its variance, is beyond the chi-square
/// quantile of one degree is left out. screen.huber: the estimate minimises half the squared distance to the
/// prediction (in P^-1) plus Huber's function of every output's residual in deviations, by iterated weights
/// to 1e-12; the covariance is that of the last weights (Durovic and Kovacevic 1999).
GARRISON_EXPORT Matrix central_kalman(const Model& model, const MatrixRef& measurements, const VectorRef& x0,
                                      double start_variance, const Screen& screen = {},
                                      const Known& known = {});

/// The same for every agent on its own: with its measurements and those of the neighbours that it hears,
/// which tell each other nothing else. x0: n x N. One (T+1) x n matrix per agent. @throws InvalidInput
GARRISON_EXPORT std::vector<Matrix> local_kalman(const Model& model, const Network& network,
                                                 const MatrixRef& measurements, const MatrixRef& x0,
                                                 double start_variance, const Screen& screen = {},
                                                 const Known& known = {});

}  // namespace garrison
