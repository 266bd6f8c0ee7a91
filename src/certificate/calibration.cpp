// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "garrison/certificate/quantiles.hpp"
#include "require.hpp"

namespace garrison::certificate {
namespace {

void require_share(const char* which, double value) {
  if (!(value > 0.0 && value < 1.0)) refuse(which, text(value), "a number in (0, 1)");
}

/// Largest k with P(Binomial(count, p) <= k) <= level; -1 when there is none.
int binomial_below(int count, double p, double level) {
  double below = 0.0;
  for (int k = 0; k <= count; ++k) {
    below += std::exp(std::lgamma(count + 1.0) - std::lgamma(k + 1.0) - std::lgamma(count - k + 1.0) +
                      k * std::log(p) + (count - k) * std::log1p(-p));
    if (below > level) return k - 1;
  }
  return count;
}

/// Lag-k correlation of a column around its mean, and how many values there are.
std::vector<double> correlations(const VectorRef& column, int lags, double& present) {
  double mean = 0.0;
  present = 0.0;
  for (const double v : column)
    if (std::isfinite(v)) {
      mean += v;
      present += 1.0;
    }
  mean /= std::max(present, 1.0);
  std::vector<double> sums(static_cast<std::size_t>(lags) + 1, 0.0);
  for (int k = 0; k <= lags; ++k)
    for (Eigen::Index t = k; t < column.size(); ++t) {
      const double product = (column(t) - mean) * (column(t - k) - mean);
      if (std::isfinite(product)) sums[static_cast<std::size_t>(k)] += product;
    }
  for (std::size_t k = sums.size(); k-- > 0;) sums[k] = sums[0] > 0.0 ? sums[k] / sums[0] : 0.0;
  return sums;
}

}  // namespace

Quantile empirical_quantile(const VectorRef& values, double delta, double confidence) {
  require_share("delta", delta);
  require_share("confidence", confidence);
  std::vector<double> sorted;
  for (const double v : values)
    if (!std::isnan(v)) sorted.push_back(v);
  std::sort(sorted.begin(), sorted.end());
  const auto T = static_cast<int>(sorted.size());
  Quantile q;
  q.values = T;
  const auto at = [&](double rank) {
    return rank >= 1.0 && rank <= T ? sorted[static_cast<std::size_t>(rank) - 1] : kNaN;
  };
  q.value = at(std::ceil((T + 1.0) * (1.0 - delta)));
  // B = values above the true level is Binomial(T, delta). The k-th largest lies above it when B >= k.
  const double tail = 0.5 * (1.0 - confidence);
  const int few = binomial_below(T, delta, tail);             // P(B <= few) <= tail
  const int many = T - binomial_below(T, 1.0 - delta, tail);  // P(B >= many) <= tail
  q.upper = few >= 0 ? at(T - few) : kNaN;
  q.lower = at(T + 1.0 - many);
  return q;
}

Whiteness whiteness(const MatrixRef& residuals, int lags) {
  if (residuals.cols() < 1) refuse("residuals", detail::shape(residuals), "at least one sensor");
  if (lags < 1 || lags >= residuals.rows())
    refuse("lags", std::to_string(lags), "a number in 1.." + std::to_string(residuals.rows() - 1));
  const Eigen::Index N = residuals.cols();
  Whiteness w{Vector::Zero(N), Vector::Zero(N), 1.0};
  for (Eigen::Index i = 0; i < N; ++i) {
    double T = 0.0;
    const auto r = correlations(residuals.col(i), lags, T);
    if (!(T > lags + 1.0)) continue;  // nothing to say
    w.correlation(i) = r[1];
    for (int k = 1; k <= lags; ++k)
      w.statistic(i) +=
          T * (T + 2.0) * r[static_cast<std::size_t>(k)] * r[static_cast<std::size_t>(k)] / (T - k);
    w.p_value = std::min(w.p_value, static_cast<double>(N) * chi_square_tail(w.statistic(i), lags));
  }
  return w;
}

}  // namespace garrison::certificate
