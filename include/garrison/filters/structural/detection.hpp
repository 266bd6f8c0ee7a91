// SPDX-License-Identifier: Apache-2.0
// Tests on residuals with exact false-alarm rates, their power, and windows of residuals.
#pragma once

#include <span>
#include <vector>

#include "garrison/filters/structural/errors.hpp"

namespace garrison::structural {

/// Probability that a zero-mean Gaussian residual stays below m standard deviations: erf(m / sqrt 2). It is
/// 1 - false-alarm rate, not a detection probability (docs/filters/structural.md#d16).
/// @throws InvalidInput unless m > 0.
GARRISON_EXPORT double kappa(double m);
/// The m with false-alarm rate `rate` per sample: sqrt 2 erfinv(1 - rate). @throws InvalidInput unless
/// 0 < rate < 1.
GARRISON_EXPORT double level_of_false_alarm(double rate);
/// The false-alarm rate at which a residual of `ratio` standard deviations is just an alarm: the kappa of
/// (19) is 1 minus this. ratio >= 0.
GARRISON_EXPORT double false_alarm_of_level(double ratio);
/// P(|N(mean, std^2)| >= threshold): what the test detects of an attack that moves the residual by `mean`.
GARRISON_EXPORT double power(double mean, double std, double threshold);
/// x with P(chi-square with `degrees` >= x) = `rate`, 0 < rate < 1, degrees >= 1.
GARRISON_EXPORT double chi_square_level(int degrees, double rate);

/// Thresholds for |r_i| at m standard deviations, m > 0: from exact standard deviations, N numbers.
GARRISON_EXPORT Vector thresholds(const Vector& residual_std, double m);
/// The paper's (17), m (|c_i| Q1 + R_ii): a variance used as a deviation, for comparison only,
/// docs/filters/structural.md#d15.
/// @throws InvalidInput when Q1 is not finite: the bound needs |Ahat|_2 < 1.
GARRISON_EXPORT Vector thresholds_printed(const Setting& s, double Q1, double m);
/// Its root, m sqrt(|c_i|^2 Q1 + R_ii): the right unit, hugely conservative.
GARRISON_EXPORT Vector thresholds_root(const Setting& s, double Q1, double m);
/// Agents with |r_i| >= threshold_i for every row of residuals (T x N). A residual that is not a number is an
/// alarm: silence would be the one wrong answer.
GARRISON_EXPORT std::vector<std::vector<int>> alarms(const MatrixRef& residuals, const Vector& threshold);

/// What a constant attack on one agent can do before it is seen, at steady state.
struct GARRISON_EXPORT Exposure {
  double smallest_seen = kNaN;  ///< least size that some agent's test detects with the asked probability
  int seen_by = -1;             ///< that agent
  double harm_per_unit = kNaN;  ///< largest steady |mean error| over agents per unit of attack
  double largest_harm = kNaN;   ///< harm of an attack of size smallest_seen: the most that stays unseen
};
/// One per agent. `false_alarm` per sample, `detection` = probability per sample of a sure detection, in (0,
/// 1).
GARRISON_EXPORT std::vector<Exposure> exposure(const Setting& s, const Stationary& x, double false_alarm,
                                               double detection);

/// Statistics over the last w residuals, T x N, NaN until the window is full. `naive` adds squares as if the
/// residuals were independent in time; `exact` uses their covariance in time (Toeplitz), v'S^-1 v.
/// `covariances`: Gam_0 .. Gam_(w-1).
GARRISON_EXPORT Matrix windows_naive(const MatrixRef& residuals, const Vector& residual_std, int w);
GARRISON_EXPORT Matrix windows_exact(const MatrixRef& residuals, std::span<const Matrix> covariances);
/// S^-1 of one agent's last w residuals, w x w; pseudo-inverse when the residual does not vary.
Matrix window_precision(std::span<const Matrix> covariances, int agent);
/// cov(q(k+h), q(k)), h = 0..lags, N x N, of the innovations q_i = y_i - c_i'xhat_i(k|k-1): white only where
/// every gain is the optimal one. `x` = stationary(s, K).
std::vector<Matrix> innovation_covariances(const Setting& s, const GainMatrices& K, const Stationary& x,
                                           int lags);
/// Isolation by templates: (t_j'S^-1 v)^2 / (t_j'S^-1 t_j) for every full window (rows) and agent j, v all
/// agents' residuals of the window and t_j the steady response to an attack on j. The largest names the
/// agent.
GARRISON_EXPORT Matrix template_statistics(const MatrixRef& residuals, std::span<const Matrix> covariances,
                                           const MatrixRef& dc_gain);

}  // namespace garrison::structural
