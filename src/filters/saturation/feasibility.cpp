// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/feasibility.hpp"

namespace garrison::saturation {
namespace {

/// Ends of {x >= 0 : -A x^2 + B x + C >= 0} for A >= 0, free of cancellation for A -> 0 (L large), where the
/// textbook formula fails. {NaN, NaN} when empty; {0, 0} is left to the caller.
Interval nonnegative_part(double A, double B, double C) {
  if (C >= 0.0) {
    const double root = std::sqrt(B * B + 4.0 * A * C);
    if (B < 0.0) return {0.0, 2.0 * C / (root - B)};
    return {0.0, A == 0.0 ? kInfinity : (B + root) / (2.0 * A)};
  }
  const double discriminant = B * B + 4.0 * A * C;
  if (B <= 0.0 || discriminant < 0.0) return {kNaN, kNaN};
  const double sum = B + std::sqrt(discriminant);
  return {-2.0 * C / sum, A == 0.0 ? kInfinity : sum / (2.0 * A)};
}

}  // namespace

double feasibility_margin(const Setting& s) {
  require_network(s);
  if (!contracts(s)) return -kInfinity;
  const double N = s.agents;
  const double c = slopes(s).c;
  const double D = N * slopes(s).Q2;
  // x = beta/eta0. Beyond `unsaturated` honest sensors are never clipped, so more beta only helps attackers.
  const double unsaturated = s.a * c < 1.0 ? s.a / (1.0 - s.a * c) : kInfinity;
  const double stationary = c > 0.0 ? (std::sqrt(s.lambda0 / D) - 1.0) / c : kInfinity;
  const double x = s.lambda0 <= D ? 0.0 : std::min(stationary, unsaturated);
  // min{a, x/(cx+1)} is a k* and has no 0/0 at a = 0.
  return 1.0 - s.a + s.lambda0 / N * std::min(s.a, x / (c * x + 1.0)) - x * D / N;
}

std::optional<int> minimal_rounds(const Setting& setting, const std::function<double(int)>& contraction) {
  const auto feasible = [&setting](double g) {
    Setting s = setting;
    s.contraction = g;
    return feasibility_margin(s) > 0.0;
  };
  if (!feasible(0.0)) return std::nullopt;
  int enough = 1;
  while (!feasible(contraction(enough))) {
    if (enough == kMostRounds) return std::nullopt;
    enough = enough > kMostRounds / 2 ? kMostRounds : 2 * enough;
  }
  for (int low = enough / 2; enough - low > 1;) {  // low is not enough (or 0), enough is
    const int middle = low + (enough - low) / 2;
    (feasible(contraction(middle)) ? enough : low) = middle;
  }
  return enough;
}

std::optional<int> minimal_rounds(const Setting& setting, double gamma) {
  if (!(gamma >= 0.0 && gamma < 1.0)) refuse("gamma (8)", text(gamma), "0 <= gamma < 1", "connect the graph");
  return minimal_rounds(setting, [gamma](int L) { return std::pow(gamma, L); });
}

double normA_max_exact(const Setting& s) {
  require_sensors(s);
  const double N = s.agents;
  const double denominator = N - s.lambda0 + s.attacked;
  return denominator > 1e-12 * N ? N / denominator : kInfinity;
}

double eps_paper(const Setting& s) {
  if (!condition11(s)) return kNaN;
  const double N = s.agents;
  return s.attacked > 0 ? (s.lambda0 - s.attacked) / (4.0 * (N - s.lambda0))
                        : s.lambda0 / (4.0 * N - s.lambda0);
}

bool condition11(const Setting& s) {
  require_sensors(s);
  return s.lambda0 > s.attacked + 1e-12 * s.agents;
}

Interval beta_interval(const Setting& s) {
  require_network(s);
  require_start_and_noise(s);
  if (!contracts(s)) return {kNaN, kNaN};
  const auto [c, Q1, Q2] = slopes(s);
  const double share = s.lambda0 / s.agents;
  const double ac = s.a * c;
  const double V = s.a * s.eta0 + s.b_w + s.b_v;
  const double u = s.eta0 * (1.0 - s.a) - Q1;
  const double b1 = ac < 1.0 ? V / (1.0 - ac) : kInfinity;  // honest sensors at eta0 saturate below b1
  Interval saturated = nonnegative_part(Q2 * ac, u * ac - Q2 * V + s.a * s.eta0 * share, u * V);
  const double room = s.eta0 * (1.0 - s.a * (1.0 - share)) - Q1;
  if (room >= 0.0 && Q2 * b1 <= room) {  // (9) holds at b1 and beyond: the interval spans both branches
    const double lo = saturated.lo <= b1 ? saturated.lo : b1;
    return {lo, Q2 > 0.0 ? std::max(room / Q2, b1) : kInfinity};
  }
  if (!(saturated.lo < b1 && saturated.hi > 0.0)) return {kNaN, kNaN};
  return {saturated.lo, std::min(saturated.hi, b1)};
}

}  // namespace garrison::saturation
