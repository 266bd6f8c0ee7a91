// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/design.hpp"

#include <numbers>
#include <string>

namespace garrison::saturation {
namespace {

/// J(beta) = lim rho_t + p0; +inf where beta is not admissible.
double bound_at(Setting s, double beta) {
  s.beta = beta;
  const FixedPoints points = fixed_points(s);
  return s.eta0 <= points.hi ? points.lo + slopes(s).c * beta : kInfinity;
}

/// Smallest admissible beta; 0 when all are (a < 1). The set is {beta : some eta >= eta0 satisfies (9)}, the
/// projection of a convex set that contains a ray, hence [result, inf).
double smallest_admissible(const Setting& s) {
  if (s.a < 1.0) return 0.0;
  double enough = s.eta0 + s.b_w + s.b_v;
  while (std::isinf(bound_at(s, enough)) && enough < kHuge) enough *= 2.0;
  double low = enough;
  while (std::isfinite(bound_at(s, low)) && low > 1.0 / kHuge) low *= 0.5;
  for (;;) {
    const double middle = low + 0.5 * (enough - low);
    if (middle <= low || middle >= enough) return enough;
    (std::isfinite(bound_at(s, middle)) ? enough : low) = middle;
  }
}

/// Golden section on ln(beta); J is quasiconvex: convex for a >= 1, and for a < 1 {beta : J <= z} is the part
/// of a half-line where a concave quadratic in beta is >= 0.
double minimise(const Setting& s, double low, double high) {
  constexpr double ratio = 1.0 / std::numbers::phi;
  double from = std::log(low);
  double to = std::log(high);
  double x1 = to - ratio * (to - from);
  double x2 = from + ratio * (to - from);
  double J1 = bound_at(s, std::exp(x1));
  double J2 = bound_at(s, std::exp(x2));
  while (to - from > 1e-9) {
    if (J1 <= J2) {
      to = x2;
      x2 = x1;
      J2 = J1;
      x1 = to - ratio * (to - from);
      J1 = bound_at(s, std::exp(x1));
    } else {
      from = x1;
      x1 = x2;
      J1 = J2;
      x2 = from + ratio * (to - from);
      J2 = bound_at(s, std::exp(x2));
    }
  }
  const double interior = std::exp(0.5 * (from + to));
  return bound_at(s, low) <= bound_at(s, interior) ? low : interior;
}

/// For a > 1 the admissible betas end above 0. For a = 1 they do so unless there is no noise, then J ~ beta.
/// For a < 1 all are admissible and the minimum is attained only if J falls at beta = 0+, where
/// J = J0 = Q1/(1-a); its slope there has the sign of -B (implicit derivative of the saturated branch).
bool attained(const Setting& s) {
  const auto [c, Q1, Q2] = slopes(s);
  if (s.a >= 1.0) return s.a > 1.0 || Q1 > 0.0;
  const double J0 = Q1 / (1.0 - s.a);
  const double B = s.a * J0 * s.lambda0 / s.agents - (Q2 + c * (1.0 - s.a)) * (s.a * J0 + s.b_w + s.b_v);
  return B > 0.0;
}

std::string why_infeasible(const Setting& s) {
  const double formula = normA_max_exact(s);
  if (s.a >= std::max(1.0, formula))
    return "no beta, eta0 and L satisfy (9): a = " + text(s.a) + " but must be < " +
           (formula >= 1.0 ? "N/(N - lambda0 + s) = " + text(formula)
                           : "1, because lambda0 < s = " + std::to_string(s.attacked)) +
           "; lower s, or raise lambda0 = " + text(s.lambda0) + " by other coordinates or more sensors";
  if (!contracts(s))
    return "L is too small: ||A|| gamma^L = " + text(s.a * s.contraction) + " >= 1; use more rounds";
  return "L is too small: no beta satisfies (9), its margin is at most " + text(feasibility_margin(s)) +
         " per unit of eta0 at contraction " + text(s.contraction) + "; use more rounds";
}

Threshold designed(const Setting& s, double margin) {
  const double edge = smallest_admissible(s);
  const double low = edge > 0.0 ? edge * (1.0 + margin) : s.eta0;
  double high = 2.0 * low;
  while (bound_at(s, 2.0 * high) < bound_at(s, high)) high *= 2.0;
  double from = low;
  if (edge == 0.0)
    while (bound_at(s, 0.5 * from) < bound_at(s, from)) from *= 0.5;
  const double beta = minimise(s, edge > 0.0 ? low : 0.5 * from, 2.0 * high);
  Setting best = s;
  best.beta = beta;
  return {beta, bound_at(s, beta), std::max(s.eta0, fixed_points(best).lo), beta_interval(s)};
}

/// Of the limit of the bound, where it only falls as beta -> 0: the threshold that is taken instead.
constexpr double kNearLimit = 1e-6;

/// lim J as beta -> 0, of a plant that contracts.
double limit(const Setting& s) { return slopes(s).Q1 / (1.0 - s.a); }

/// Where no threshold is best, one whose bound is so near to the limit that no other is better by more.
Threshold near_limit(const Setting& s) {
  Setting near = s;
  near.beta = s.eta0;
  while (bound_at(s, near.beta) > limit(s) * (1.0 + kNearLimit) && near.beta > 1.0 / kHuge) near.beta *= 0.5;
  return {near.beta, bound_at(s, near.beta), std::max(s.eta0, fixed_points(near).lo), beta_interval(s)};
}

/// Whether near_limit() has a limit to come near to.
bool falls_to_a_limit(const Setting& s) { return s.a < 1.0 && limit(s) > 0.0 && !attained(s); }

void require_fraction(const char* which, double value) {
  if (!(value >= 0.0 && std::isfinite(value))) refuse(which, text(value), "a finite number >= 0");
}

void require_feasible(const Setting& s, double margin) {
  require_network(s);
  require_start_and_noise(s);
  require_fraction("margin", margin);
  if (!(feasibility_margin(s) > 0.0)) throw DesignInfeasible(why_infeasible(s));
}

Threshold best_or_near(const Setting& s, double margin) {
  if (!falls_to_a_limit(s)) return best_threshold(s, margin);
  require_feasible(s, margin);
  return near_limit(s);
}

}  // namespace

Threshold best_threshold(const Setting& s, double margin) {
  require_feasible(s, margin);
  if (!attained(s))
    throw DesignInfeasible("no best beta: a = " + text(s.a) +
                           " <= 1 and the bound only falls as beta -> 0, to " +
                           text(s.a < 1.0 ? limit(s) : 0.0) + "; choose beta for the speed of convergence");
  return designed(s, margin);
}

Design design_rounds_and_threshold(const Setting& setting, const std::function<double(int)>& contraction,
                                   int least, int most, double slack, double margin) {
  if (least < 1 || most < least)
    refuse("rounds", std::to_string(least) + ".." + std::to_string(most), "1 <= least <= most");
  require_fraction("slack", slack);
  Setting s = setting;
  s.contraction = contraction(most);
  const std::optional<int> fewest = minimal_rounds(s, contraction);
  if (fewest && *fewest > most)
    throw DesignInfeasible(why_infeasible(s) + " (at most " + std::to_string(most) +
                           " allowed, the smallest feasible L is " + std::to_string(*fewest) + ")");
  const Threshold best = best_or_near(s, margin);
  const double enough = best.bound * (1.0 + slack + (falls_to_a_limit(s) ? kNearLimit : 0.0));
  const auto good = [&](int L) {
    s.contraction = contraction(L);
    return (attained(s) || falls_to_a_limit(s)) && best_or_near(s, margin).bound <= enough;
  };
  int few = std::max(least, *fewest);
  for (int many = most; few < many;) {
    const int middle = few + (many - few) / 2;
    if (good(middle))
      many = middle;
    else
      few = middle + 1;
  }
  s.contraction = contraction(few);
  return {few, s.contraction, best_or_near(s, margin), *fewest};
}

}  // namespace garrison::saturation
