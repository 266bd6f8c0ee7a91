// SPDX-License-Identifier: Apache-2.0
// Runs of the structural filter on honest data, and how often it alarms.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../../random_system.hpp"
#include "garrison/drivers/simulate.hpp"

namespace garrison::test {

/// One scalar sensor per row of C, variance r each; process covariance Q.
inline Model known_model(const Matrix& A, const Matrix& C, const Matrix& Q, double r) {
  Noise noise;
  noise.process_covariance = Q;
  noise.measurement_covariance.assign(static_cast<std::size_t>(C.rows()), Matrix::Constant(1, 1, r));
  std::vector<Matrix> rows;
  for (Eigen::Index i = 0; i < C.rows(); ++i) rows.emplace_back(C.row(i));
  return {A, rows, noise};
}

/// Alarms per tested sample: mean over the trials, and its standard error.
struct Rate {
  double mean = 0.0;
  double error = 0.0;
  double tested = 0.0;  ///< share of the samples
};

inline Rate alarm_rate(const Record& r, int from) {
  std::vector<double> alarms(static_cast<std::size_t>(r.trials), 0.0);
  double tested = 0.0;
  double all = 0.0;
  double sum = 0.0;
  const auto block = static_cast<std::size_t>(r.agents) * static_cast<std::size_t>(r.steps + 1);
  for (std::size_t k = 0; k < r.statistic.size(); ++k) {
    if (static_cast<int>(k % block) / r.agents < from || std::isnan(r.statistic[k])) continue;
    all += 1.0;
    if (std::isnan(r.threshold[k])) continue;
    tested += 1.0;
    const double alarm = r.statistic[k] >= r.threshold[k] ? 1.0 : 0.0;
    alarms[k / block] += alarm;
    sum += alarm;
  }
  Rate rate;
  rate.tested = all > 0.0 ? tested / all : 0.0;
  if (tested == 0.0) return rate;
  rate.mean = sum / tested;
  const double per = tested / r.trials;
  for (const double a : alarms) rate.error += std::pow(a / per - rate.mean, 2);
  rate.error = std::sqrt(rate.error / (r.trials - 1.0) / r.trials);
  return rate;
}

}  // namespace garrison::test
