// SPDX-License-Identifier: Apache-2.0
// What can be promised: bounds under attack, region and rate of convergence without.
#pragma once

#include "garrison/filters/rdkf/steady_state.hpp"
#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf {

/// Theorem III.3: without attack, a start with V = max_i e_i' P_i^-1 e_i at most this never saturates and V
/// falls by the factor `rate` per step. +inf where nobody has a sensor.
struct Levels {
  double printed;    ///< with 2 lambda, as printed: FALSE (docs/filters/rdkf.md#r5, r6), for comparison only
  double corrected;  ///< with lambda, agents coupled
  double refined;    ///< with the sharper threshold of docs/filters/rdkf.md#r7; at least `corrected`
};

struct GARRISON_EXPORT Constants {
  /// (10) with its transpose restored: two measurements of one agent, whatever they are, lead to estimates at
  /// most this far apart. One number per agent; 0 without sensors.
  Vector resiliency_bound;
  /// Half of it: the estimate is at most this far from the fused prediction, whatever is measured.
  Vector prior_deviation_bound;
  Vector refined_threshold;  ///< t_i of docs/filters/rdkf.md#r7; +inf without sensors
  Levels level;              ///< `norm` only, NaN for other penalties
  double rate;  ///< gamma < 1 of docs/filters/rdkf.md#r8: V_k <= gamma V_{k-1} (for (7) from anywhere)
  double eta;   ///< the same with Q_j in place of P_j^-1: growth of the prediction error, one step
  double dkf_error_radius;    ///< spectral radius of the error of (7)
  double prior_error_radius;  ///< of the error when no measurement is used; at least the radius of A
  /// No attack, however long, moves the estimate of agent i by more than this from where it would be without
  /// any measurement; +inf where prior_error_radius >= 1 (no bound for persistent attacks); NaN, like the
  /// radii, where the stacked error has more than 1000 entries. Never less than the series of
  /// docs/filters/rdkf.md#r-persistent: what is cut off is bounded.
  Vector persistent_bound;
};

/// How far a measurement moves the estimate of agent i from the fused prediction at most: half of (10),
/// lambda/2 times the largest |Q_i^-1 M' u| over the dual ball (`norm`, `huber`), box or product of balls.
double deviation_bound(const Setting& s, const SteadyState& steady, int i, double lambda, Penalty penalty);

/// All constants for weight lambda >= 0. For `l1` and `group` the deviation bounds are sums over the terms.
GARRISON_EXPORT Constants constants(const Setting& s, const SteadyState& steady, double lambda,
                                    Penalty penalty);

/// ||Q_i^-1 Pbar_j^-1 A / d_i|| for every j in N_i: what of neighbour j's error enters the prediction of
/// agent i.
std::vector<double> prior_error_norms(const Setting& s, const SteadyState& steady, int agent);

/// max_i e_i' P_i^-1 e_i for errors e, n x N.
GARRISON_EXPORT double lyapunov(const SteadyState& steady, const MatrixRef& errors);

/// One agent, one state: the exact radius of |xhat_0 - x_0| from which (8) converges without attack or noise;
/// deviation bound / (|a| - 1) for |a| > 1, else +inf. NaN for more agents or states.
GARRISON_EXPORT double scalar_basin(const Setting& s, const SteadyState& steady, double lambda);

}  // namespace garrison::rdkf
