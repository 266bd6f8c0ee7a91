// SPDX-License-Identifier: Apache-2.0
// Gaussian and chi-square levels.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "garrison/filters/structural/detection.hpp"

namespace garrison::structural {
namespace {

void require_rate(const std::string& which, double rate) {
  if (!(rate > 0.0 && rate < 1.0)) refuse(which, text(rate), "a probability in (0, 1)");
}

void require_level(double m) {
  if (!(m > 0.0)) refuse("m", text(m), "a number > 0");
}

/// P(chi-square with d degrees >= x): regularised upper incomplete gamma function Q(d/2, x/2), by its finite
/// sums: Q(a + 1, z) = Q(a, z) + z^a e^-z / Gamma(a + 1).
double chi_square_tail(int degrees, double x) {
  const double z = 0.5 * x;
  double a = degrees % 2 == 0 ? 1.0 : 0.5;
  double tail = degrees % 2 == 0 ? std::exp(-z) : std::erfc(std::sqrt(z));
  double term = degrees % 2 == 0 ? z * std::exp(-z) : std::sqrt(z) * std::exp(-z) / std::tgamma(1.5);
  for (; a < 0.5 * degrees - 0.25; a += 1.0) {
    tail += term;
    term *= z / (a + 1.0);
  }
  return tail;
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
  // erfc(m / sqrt 2) = rate by bisection, then Newton on the logarithm, which is nearly a parabola.
  double lo = 0.0;
  double hi = 40.0;
  for (int k = 0; k < 40; ++k) {
    const double mid = 0.5 * (lo + hi);
    (false_alarm_of_level(mid) > rate ? lo : hi) = mid;
  }
  double m = 0.5 * (lo + hi);
  for (int k = 0; k < 4; ++k) {
    const double tail = false_alarm_of_level(m);
    const double density = 2.0 * std::exp(-0.5 * m * m) / std::sqrt(2.0 * std::numbers::pi);
    if (tail > 0.0 && density > 0.0) m += tail * (std::log(tail) - std::log(rate)) / density;
  }
  return m;
}

double power(double mean, double std, double threshold) {
  if (!(std > 0.0)) refuse("std", text(std), "a number > 0");
  const double scale = 1.0 / (std * std::numbers::sqrt2);
  return 0.5 * (std::erfc((threshold - mean) * scale) + std::erfc((threshold + mean) * scale));
}

double chi_square_level(int degrees, double rate) {
  require_rate("false_alarm", rate);
  // Beyond, e^(-x/2) is no number any more and the sum says nothing.
  constexpr int most = 1000;
  if (degrees < 1 || degrees > most)
    refuse("degrees (window)", std::to_string(degrees), "1.." + std::to_string(most));
  double lo = 0.0;
  double hi = 10.0;
  while (chi_square_tail(degrees, hi) > rate) hi *= 2.0;
  for (int k = 0; k < 200 && hi - lo > 1e-15 * hi; ++k) {
    const double mid = 0.5 * (lo + hi);
    (chi_square_tail(degrees, mid) > rate ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
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
