// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "require.hpp"

namespace garrison::certificate {
namespace {

void require_probability(const char* which, double delta) {
  if (!(delta > 0.0 && delta < 1.0)) refuse(which, text(delta), "a probability in (0, 1)");
}

/// z^a e^-z / Gamma(a + 1): what both halves of the incomplete gamma function share.
double front(double a, double z) {
  return z > 0.0 ? std::exp(a * std::log(z) - z - std::lgamma(a + 1.0)) : 0.0;
}

/// Regularised incomplete gamma function, (lower, upper): the series or the continued fraction, whichever
/// converges, and the other one by subtraction, which is then not the smaller.
std::pair<double, double> gamma_halves(double a, double z) {
  if (z <= 0.0) return {0.0, 1.0};
  if (z < a + 1.0) {
    double term = 1.0;
    double sum = 1.0;
    for (double k = a + 1.0; term > 1e-17 * sum; k += 1.0) sum += term *= z / k;
    const double lower = front(a, z) * sum;
    return {lower, 1.0 - lower};
  }
  // Lentz's form of the fraction for Gamma(a, z) e^z z^-a.
  double b = z + 1.0 - a;
  double c = 1e300;
  double d = 1.0 / b;
  double h = d;
  for (double k = 1.0; k < 1e6; k += 1.0) {
    const double an = -k * (k - a);
    b += 2.0;
    d = an * d + b;
    c = b + an / c;
    d = 1.0 / (d == 0.0 ? 1e-300 : d);
    if (c == 0.0) c = 1e-300;
    const double step = c * d;
    h *= step;
    if (std::abs(step - 1.0) < 1e-16) break;
  }
  const double upper = front(a, z) * a * h;
  return {1.0 - upper, upper};
}

/// Root of tail(x) = delta for a tail that falls from 1 to 0 on x > 0. `halves` gives (1 - tail, tail): the
/// one that is at most one half is compared, so that nothing is lost to rounding near either end.
template <class Halves>
double quantile(double delta, double start, const Halves& halves) {
  const auto beyond = [&](double x) {  // x is below the root
    const auto [head, tail] = halves(x);
    return delta > 0.5 ? head < 1.0 - delta : tail > delta;
  };
  double hi = start;
  while (beyond(hi)) hi *= 2.0;
  double lo = hi;
  while (lo > 0.0 && !beyond(lo)) lo *= 0.5;
  while (true) {
    const double mid = 0.5 * (lo + hi);
    if (!(mid > lo && mid < hi)) return hi;
    (beyond(mid) ? lo : hi) = mid;
  }
}

/// Largest |sum_K V/R| / sqrt(sum_K 1/R) over all sets with at most `missing` sensors left out.
class LargestStatistic {
 public:
  LargestStatistic(const Vector& v, const Vector& inverse)
      : a_(v.cwiseProduct(inverse)), b_(inverse), rest_a_(v.size() + 1), rest_b_(v.size() + 1) {
    rest_a_(v.size()) = 0.0;
    rest_b_(v.size()) = 0.0;
    for (Eigen::Index j = v.size(); j-- > 0;) {
      rest_a_(j) = rest_a_(j + 1) + a_(j);
      rest_b_(j) = rest_b_(j + 1) + b_(j);
    }
  }

  double over(int missing) const { return walk(0, 0.0, 0.0, missing); }

 private:
  /// a, b: sums over what is kept before `first`. Sums are built up, never subtracted.
  double walk(Eigen::Index first, double a, double b, int missing) const {
    double most = std::abs(a + rest_a_(first)) / std::sqrt(b + rest_b_(first));
    if (missing == 0) return most;
    for (Eigen::Index j = first; j < a_.size(); ++j) {
      if (b + rest_b_(j + 1) > 0.0) most = std::max(most, walk(j + 1, a, b, missing - 1));
      a += a_(j);
      b += b_(j);
    }
    return most;
  }

  Vector a_, b_;
  Vector rest_a_, rest_b_;  // sums over the sensors from j on
};

double order_statistic(std::vector<double> values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

double two_sided(double delta) {
  require_probability("delta", delta);
  return quantile(delta, 1.0, [](double z) {
    const double x = z / std::numbers::sqrt2;
    return std::pair(std::erf(x), std::erfc(x));
  });
}

double chi(double delta, int degrees) {
  require_probability("delta", delta);
  detail::require_least("degrees", degrees, 1);
  if (degrees == 1) return two_sided(delta);
  return std::sqrt(2.0 *
                   quantile(delta, 0.5 * degrees, [&](double z) { return gamma_halves(0.5 * degrees, z); }));
}

double chi_square_tail(double square, int degrees) {
  detail::require_least("degrees", degrees, 1);
  if (!(square >= 0.0)) refuse("square", text(square), "a number >= 0");
  return std::isinf(square) ? 0.0 : gamma_halves(0.5 * degrees, 0.5 * square).second;
}

double sub_gaussian_two_sided(double delta) {
  require_probability("delta", delta);
  return std::sqrt(2.0 * (std::numbers::ln2 - std::log(delta)));
}

double sub_gaussian_chi(double delta, int degrees) {
  require_probability("delta", delta);
  detail::require_least("degrees", degrees, 1);
  const double u = -std::log(delta);
  return std::sqrt(degrees + 2.0 * std::sqrt(degrees * u) + 2.0 * u);
}

Levels gaussian_levels(double delta, int rows, int states) {
  require_probability("delta", delta);
  detail::require_least("rows", rows, 1);
  return {two_sided(0.5 * delta / rows), chi(0.5 * delta, states)};
}

Levels sub_gaussian_levels(double delta, int rows, int states) {
  require_probability("delta", delta);
  detail::require_least("rows", rows, 1);
  return {sub_gaussian_two_sided(0.5 * delta / rows), sub_gaussian_chi(0.5 * delta, states)};
}

Levels calibrated_levels(const MatrixRef& V, const VectorRef& R, int s, double delta) {
  require_probability("delta", delta);
  detail::require_shape("V", V, V.rows(), R.size());
  detail::require_bounds("R", R, R.size());
  if (V.rows() < 1 || V.cols() < 1) refuse("V", detail::shape(V), "at least one sample of one sensor");
  if (!(R.minCoeff() > 0.0)) refuse("R", text(R.minCoeff()), "variances > 0");
  const auto N = static_cast<int>(R.size());
  if (s < 0 || s >= N) refuse("s", std::to_string(s), "a number in 0.." + std::to_string(N - 1));
  const auto T = static_cast<std::size_t>(V.rows());
  const double rank = std::ceil((static_cast<double>(T) + 1.0) * (1.0 - 0.5 * delta));
  if (rank > static_cast<double>(T))
    refuse("delta", text(delta), "at least 2/(T+1) = " + text(2.0 / (static_cast<double>(T) + 1.0)),
           "give more clean samples");
  double sets = 1.0;
  double choices = 1.0;
  for (int k = 1; k <= s; ++k) sets += choices *= static_cast<double>(N - k + 1) / k;
  if (!(sets * static_cast<double>(T) <= 2e8))
    refuse("s", std::to_string(s), "at most 2e8 sums over samples and sets",
           "take fewer samples or a smaller s");
  const Vector inverse = R.cwiseInverse();
  std::vector<double> single(T);
  std::vector<double> joint(T);
  for (std::size_t t = 0; t < T; ++t) {
    const auto v = V.row(static_cast<Eigen::Index>(t)).transpose();
    single[t] = (v.array().abs() / R.array().sqrt()).maxCoeff();
    joint[t] = LargestStatistic(v, inverse).over(s);
  }
  const auto k = static_cast<std::size_t>(rank);
  return {order_statistic(std::move(single), k), order_statistic(std::move(joint), k)};
}

}  // namespace garrison::certificate
