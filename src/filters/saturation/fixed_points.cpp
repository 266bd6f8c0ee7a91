// SPDX-License-Identifier: Apache-2.0
// Fixed points of r -> F(r) r + q0 (docs/filters/saturation.md#s-closed). Up to r1 no honest sensor saturates
// and F is constant: a linear inequality. Beyond r1 the gain falls like 1/r: a quadratic one.
#include "garrison/filters/saturation/constants.hpp"

namespace garrison::saturation {
namespace {

constexpr FixedPoints kNone{kNaN, kNaN};
bool exists(const FixedPoints& part) { return part.lo <= part.hi; }

/// {r >= 0 : alpha r^2 + B r + C <= 0} for C >= 0. No subtraction of nearly equal numbers except in the
/// discriminant, and alpha -> 0 (a = 1) is no special case.
FixedPoints quadratic(double alpha, double B, double C) {
  const double discriminant = B * B - 4.0 * alpha * C;
  if (discriminant < 0.0) return kNone;
  const double root = std::sqrt(discriminant);
  if (B < 0.0) return {2.0 * C / (root - B), alpha > 0.0 ? (root - B) / (2.0 * alpha) : kInfinity};
  if (alpha < 0.0) return {(root + B) / (-2.0 * alpha), kInfinity};
  if (C > 0.0) return kNone;
  return {0.0, alpha == 0.0 && B == 0.0 ? kInfinity : 0.0};
}

/// {0 <= r <= r1 : m r >= q0}.
FixedPoints linear(double m, double q0, double r1) {
  if (r1 < 0.0) return kNone;
  if (q0 == 0.0) return {0.0, m >= 0.0 ? r1 : 0.0};
  return m > 0.0 && q0 / m <= r1 ? FixedPoints{q0 / m, r1} : kNone;
}

}  // namespace

FixedPoints fixed_points(const Setting& s, double given_q0) {
  require(s);
  if (!std::isfinite(given_q0)) refuse("q0", text(given_q0), "a finite number");
  if (!contracts(s)) return kNone;
  const double q0 = std::max(given_q0, 0.0);
  if (s.a == 0.0) return {q0, kInfinity};
  const double b = s.b_w + s.b_v;
  const double p0 = slopes(s).c * s.beta;
  const double share = s.lambda0 / s.agents;
  const double r1 = (s.beta - b) / s.a - p0;
  const double c = p0 + b / s.a;

  const FixedPoints low = linear(1.0 - s.a * (1.0 - share), q0, r1);
  FixedPoints high = quadratic(s.a - 1.0, q0 + (s.a - 1.0) * c - s.beta * share, q0 * c);
  high.lo = std::max({high.lo, r1, 0.0});
  if (!exists(low)) return exists(high) ? high : kNone;
  return {low.lo, exists(high) ? high.hi : low.hi};
}

FixedPoints fixed_points(const Setting& s) {
  require(s);
  if (!contracts(s)) return kNone;
  return fixed_points(s, honest_offset(s, slopes(s).c * s.beta) + s.attacked * s.beta / s.agents);
}

}  // namespace garrison::saturation
