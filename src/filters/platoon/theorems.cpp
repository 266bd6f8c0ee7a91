// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/platoon/theorems.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/filters/platoon/bounds.hpp"

namespace garrison::platoon {
namespace {

/// f_1 of (23).
double f1(const Setting& s) { return (s.eps + mubar(s)) * honest(s) / (2.0 * s.range); }

Interval between(double lo, double hi) {
  return lo > 0.0 && lo < hi ? Interval{lo, hi} : Interval{kNaN, kNaN};
}

/// alpha2 and alpha3 of (21) and (26), the fixed points of (18) and (19).
double free_limit(const Setting& s) {
  return (s.eps * (s.varpi - 1.0) + s.mu) / (s.varpi - (s.varpi - 1.0) * norm_A(s));
}
double borrowed_limit(const Setting& s, double source, int distance) {
  return (s.eps * s.varpi + s.mu * distance + norm_A(s) * source) / (s.varpi - (s.varpi - 1.0) * norm_A(s));
}

/// One step of the safe bound with empty sets.
double blind(const Setting& s, double rho) {
  const double E = predicted(s, rho);
  return safe_bound(s, threshold(s, E), E, {0, 2 * s.range + 1, 0, 0});
}

bool feasible(const Setting& s) { return !std::isnan(beta_interval_safe(s).lo); }

/// Least value from `low` (not feasible) on, doubling, for which `good` holds, to two digits upwards; NaN
/// when none.
template <class Good>
double least_value(double low, const Good& good) {
  if (good(low)) return low;
  constexpr int kMostDoublings = 60;
  double high = low;
  for (int k = 0; k < kMostDoublings && !good(high); ++k) high *= 2.0;
  if (!good(high)) return kNaN;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (good(middle) ? high : low) = middle;
  }
  const double unit = std::pow(10.0, std::floor(std::log10(high)) - 1.0);
  for (double rounded = std::ceil(high / unit) * unit; rounded < 2.0 * high; rounded += unit)
    if (good(rounded)) return rounded;
  return high;
}

/// What makes a threshold exist, found by trying: a larger initial error (the bound cannot fall below what
/// noise allows, so q must not start there), less noise, or less to tolerate.
std::string advice(const Setting& given) {
  Setting s = given;
  const double q = least_value(given.q, [&](double value) {
    s.q = value;
    return feasible(s);
  });
  if (!std::isnan(q)) return "raise initial_error (q) to " + text(q);
  s = given;
  for (s.attacked = given.attacked - 1; s.attacked >= 1; --s.attacked) {
    Setting large = s;
    const double enough = least_value(given.q, [&](double value) {
      large.q = value;
      return feasible(large);
    });
    if (!std::isnan(enough))
      return "lower attacked (b) to " + std::to_string(s.attacked) +
             (enough > given.q ? " and raise initial_error (q) to " + text(enough) : "") +
             ", or widen the range or shorten the period";
  }
  return "widen the range or shorten the period: no initial error helps";
}

}  // namespace

double beta1_bar(const Setting& s, double omega) {
  require(s);
  return 2.0 * s.range / honest(s) * (omega + norm_A(s) - 1.0) * beta0(s) / norm_A(s);
}

double beta2_bar(const Setting& s, double omega) {
  require(s);
  return std::min(beta0(s), 2.0 * s.range / s.attacked * (omega * s.q - f1(s)));
}

bool proposition2(const Setting& s, double omega) {
  require(s);
  const double nA = norm_A(s);
  const double f2 = (omega * (s.eps + mubar(s)) + (nA - 1.0) * beta0(s)) / nA;
  const double below = omega * s.q - f1(s);
  return below > 0.0 && static_cast<double>(honest(s)) / s.attacked > (omega * s.q + f2) / below &&
         honest(s) / (2.0 * s.range) > (omega + nA - 1.0) / nA;
}

double f3(const Setting& s, double omega) {
  require(s);
  const double more = norm_A(s) - 1.0;
  return (s.range + 0.5) * (1.0 - more / (2.0 * omega + more));
}

double f4(const Setting& s, double omega) {
  require(s);
  return 1.0 + 2.0 * s.range * (1.0 - omega) / norm_A(s);
}

Interval omega_interval(const Setting& s) {
  require(s);
  const double nA = norm_A(s);
  const double Lb = honest(s);
  const double b = s.attacked;
  const double below = (Lb - b) * s.q - b * (s.eps + mubar(s)) / nA;
  if (!(below > 0.0)) return {kNaN, kNaN};
  return between((Lb * f1(s) + b * (nA - 1.0) * beta0(s) / nA) / below,
                 std::min(1.0, nA * Lb / (2.0 * s.range) - nA + 1.0));
}

Interval beta_interval(const Setting& s) {
  require(s);
  const double nA = norm_A(s);
  const double slope = (honest(s) * nA * s.q / beta0(s) - s.attacked) / (2.0 * s.range);
  if (!(slope > 0.0)) return {kNaN, kNaN};
  return between((f1(s) + (nA - 1.0) * s.q) / slope, beta0(s));
}

Interval beta_interval_safe(const Setting& s) {
  require(s);
  const double nA = norm_A(s);
  const double two_L = 2.0 * s.range;
  const double slope = (honest(s) * (nA * s.q + s.eps) / beta0(s) - s.attacked) / two_L;
  if (!(slope > 0.0)) return {kNaN, kNaN};
  return between(((nA - 1.0) * s.q + s.eps + honest(s) * mubar(s) / two_L) / slope, beta0(s));
}

double safe_limit(const Setting& s) {
  require(s);
  constexpr int kMostSteps = 20'000'000;
  if (s.adaptive) {
    // Affine in rho, because kbar = min(1, k0) does not depend on it: two values give the line.
    const double at0 = blind(s, 0.0);
    const double slope = (blind(s, s.q) - at0) / s.q;
    return slope < 1.0 ? at0 / (1.0 - slope) : kNaN;
  }
  // Static: monotone from q, because the map is increasing; above the largest fixed point it grows for ever.
  double rho = s.q;
  for (int t = 0; t < kMostSteps; ++t) {
    const double next = blind(s, rho);
    if (std::abs(next - rho) <= 1e-16 * rho) return next;
    if (next > rho && next > 1e6 * (s.q + beta0(s))) return kNaN;
    rho = next;
  }
  return rho;
}

double best_threshold(const Setting& given) {
  Setting s = given;
  s.adaptive = true;
  s.beta = 1.0;
  const Interval all = beta_interval_safe(s);
  if (std::isnan(all.lo))
    throw DesignInfeasible("threshold (beta): no value makes the error bound contract for N = " +
                           std::to_string(s.vehicles) + ", L = " + std::to_string(s.range) +
                           ", b = " + std::to_string(s.attacked) + ", q = " + text(s.q) + "; " + advice(s));
  // |1 - lo/2L| and hence the limit is a convex-over-linear function of beta: unimodal, golden section finds
  // it.
  const auto limit = [&](double beta) {
    s.beta = beta;
    const double found = safe_limit(s);
    return std::isnan(found) ? kInfinity : found;
  };
  const double golden = (std::sqrt(5.0) - 1.0) / 2.0;
  double lo = all.lo;
  double hi = all.hi;
  for (int k = 0; k < 100; ++k) {
    const double left = hi - golden * (hi - lo);
    const double right = lo + golden * (hi - lo);
    (limit(left) <= limit(right) ? hi : lo) = limit(left) <= limit(right) ? right : left;
  }
  return (lo + hi) / 2.0;
}

StaticBounds theorem1(const Setting& s, const Known& known) {
  require(s);
  const double two_L = 2.0 * s.range;
  StaticBounds b{};
  b.k_star = s.beta / beta0(s);
  b.Q = ((s.eps + mubar(s)) * honest(s) + (s.attacked - known.proved) * s.beta) / two_L;
  b.m = 1.0 - (known.free_in_reach + (honest(s) - known.free_in_reach) * b.k_star) / two_L;
  b.alpha1 = b.m * norm_A(s) < 1.0 ? b.Q / (1.0 - b.m * norm_A(s)) : kNaN;
  b.alpha2 = free_limit(s);
  b.alpha3 = std::isnan(b.alpha1) ? kNaN : borrowed_limit(s, std::max(b.alpha1, b.alpha2), known.distance);
  return b;
}

AdaptiveBounds theorem2(const Setting& s, const Known& known) {
  require(s);
  const double two_L = 2.0 * s.range;
  AdaptiveBounds b{};
  b.k0 = k0(s);
  b.h1 = 1.0 -
         (known.free_in_reach + (honest(s) - s.attacked + known.proved - known.free_in_reach) * b.k0) / two_L;
  b.h2 = (honest(s) + (s.attacked - known.proved) * b.k0) / two_L * (s.eps + mubar(s));
  b.alpha1 = b.h1 * norm_A(s) < 1.0 ? b.h2 / (1.0 - b.h1 * norm_A(s)) : kNaN;
  b.alpha2 = free_limit(s);
  b.alpha3 = std::isnan(b.alpha1) ? kNaN : borrowed_limit(s, std::max(b.alpha1, b.alpha2), known.distance);
  return b;
}

}  // namespace garrison::platoon
