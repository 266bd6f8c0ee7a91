// SPDX-License-Identifier: Apache-2.0
// Gaussian and chi-square levels.
#include <cmath>
#include <numbers>

#include "garrison/certificate/quantiles.hpp"
#include "garrison/filters/structural/detection.hpp"

namespace garrison::structural {
namespace {

void require_rate(const std::string& which, double rate) {
  if (!(rate > 0.0 && rate < 1.0)) refuse(which, text(rate), "a probability in (0, 1)");
}

void require_level(double m) {
  if (!(m > 0.0)) refuse("m", text(m), "a number > 0");
}

}  // namespace

double kappa(double m) {
  require_level(m);
  return std::erf(m / std::numbers::sqrt2);
}

double false_alarm_of_level(double ratio) {
  if (!(ratio >= 0.0)) refuse("ratio", text(ratio), "a number >= 0");
  return std::erfc(ratio / std::numbers::sqrt2);
}

double level_of_false_alarm(double rate) {
  require_rate("false_alarm", rate);
  return certificate::two_sided(rate);
}

double power(double mean, double std, double threshold) {
  if (!(std > 0.0)) refuse("std", text(std), "a number > 0");
  const double scale = 1.0 / (std * std::numbers::sqrt2);
  return 0.5 * (std::erfc((threshold - mean) * scale) + std::erfc((threshold + mean) * scale));
}

double chi_square_level(int degrees, double rate) {
  require_rate("false_alarm", rate);
  constexpr int most = 1000;
  if (degrees < 1 || degrees > most)
    refuse("degrees (window)", std::to_string(degrees), "1.." + std::to_string(most));
  const double length = certificate::chi(rate, degrees);
  return length * length;
}

Vector thresholds(const Vector& residual_std, double m) {
  require_level(m);
  return m * residual_std;
}

namespace {
void require_bound(double Q1) {
  if (!(Q1 >= 0.0 && std::isfinite(Q1)))
    refuse("bound", text(Q1), "a finite Q1 >= 0",
           "the bound needs |Ahat|_2 < 1; the exact thresholds do not");
}
}  // namespace

Vector thresholds_printed(const Setting& s, double Q1, double m) {
  require_level(m);
  require_bound(Q1);
  require_valid(s);
  return m * (s.C.rowwise().norm() * Q1 + s.R.diagonal());
}

Vector thresholds_root(const Setting& s, double Q1, double m) {
  require_level(m);
  require_bound(Q1);
  require_valid(s);
  return m * (s.C.rowwise().squaredNorm() * Q1 + s.R.diagonal()).cwiseSqrt();
}

}  // namespace garrison::structural
