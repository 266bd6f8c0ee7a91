// SPDX-License-Identifier: Apache-2.0
// `garrison check` for the saturation filter: each condition with its value, and the bounds that follow.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <vector>

#include "core/hops.hpp"
#include "core/solvers.hpp"
#include "facts.hpp"
#include "garrison/analysis/observability.hpp"
#include "garrison/core/spectrum.hpp"
#include "garrison/filters/saturation/adaptive.hpp"
#include "garrison/filters/saturation/design.hpp"
#include "garrison/filters/saturation/feasibility.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/filters/saturation/theorems.hpp"
#include "garrison/kernel/chebyshev.hpp"

namespace garrison {
namespace {

using namespace saturation;

/// A radius or norm of 1 up to rounding does not settle.
constexpr double kRadiusMargin = 1e-9;

/// Six digits, as the command line prints the value beside it.
std::string six_digits(double value) {
  std::array<char, 32> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 6).ptr;
  return {buffer.data(), end};
}
std::string above(double value) { return "> " + text(value); }

/// Three digits, never below the value: what satisfies a condition still does.
std::string rounded_up(double value) {
  const double digits = 2.0 - std::floor(std::log10(value));
  const double scale = std::pow(10.0, std::abs(digits));  // a whole number: 31.9, not 31.900000000000002
  return text(digits >= 0.0 ? std::ceil(value * scale * (1.0 - 1e-12)) / scale
                            : std::ceil(value / scale * (1.0 - 1e-12)) * scale);
}

bool scalar_unit_rows(const Model& model) {
  for (int i = 0; i < model.agents(); ++i)
    if (model.outputs(i) > 1 || (model.outputs(i) == 1 && std::abs(model.C(i).norm() - 1.0) > 1e-9))
      return false;
  return true;
}

/// What to do about rows that are not scalar_unit_rows.
std::string row_advice(const Model& model) {
  for (int i = 0; i < model.agents(); ++i)
    if (model.outputs(i) == 1 && model.C(i).isZero(0.0))
      return "the sensor of agent " + std::to_string(i) +
             " sees nothing of the state (its row of C is zero): take the row away";
  return "assumption of all bounds; see normalise_rows and split_outputs";
}

/// Samples until what one agent knows has reached everybody: at most twice the distance to the farthest from
/// agent 0.
int spread_of(const Network& network, int rounds) {
  const int across = 2 * garrison::detail::hops_from(network, 0).furthest;
  return rounds > 0 ? (across + rounds - 1) / rounds : 0;
}

/// What to do when (11) fails.
std::string remedy11(const Matrix& C, int attacked) {
  constexpr int kMostTries = 8;  // each one is a search
  const std::string sensors = "add sensors of the direction that is seen least";
  for (int s = attacked - 1; s >= std::max(0, attacked - kMostTries); --s)
    if (lambda0(C, s, usual_limits(C.rows(), C.cols())).lower > s + 1e-9)
      return sensors + ", or protect some: attacked = " + std::to_string(s) + " satisfies it";
  return sensors;
}

/// What to do when (9) fails.
std::string remedy9(const Setting& s, const FixedPoints& points, const Interval& thresholds) {
  constexpr double kFar = 1e9;  // a start that far off is nobody's: then the threshold is what is too small
  const bool far = points.lo > kFar * s.eta0 && thresholds.lo > 0.0;
  if (!std::isnan(points.lo) && s.eta0 < points.lo && !far)
    return "raise initial_error to " + rounded_up(points.lo);
  if (!std::isnan(thresholds.lo))
    return "choose a threshold from " + text(thresholds.lo) + " to " + text(thresholds.hi);
  if (!std::isnan(points.hi) && s.eta0 > points.hi)
    return "lower initial_error to " + text(points.hi) + ", or take more rounds";
  try {
    const Threshold best = best_threshold(s);
    return "threshold " + rounded_up(best.beta) + " with initial_error " + rounded_up(1.001 * best.eta0) +
           " satisfies it";
  } catch (const DesignInfeasible& e) {
    return e.what();
  }
}

/// What to do when (12) fails.
std::string remedy12(Setting s, double varpi) {
  constexpr double kStep = 1.1;
  constexpr int kMost = 200;
  for (int k = 0; k < kMost; ++k, s.beta *= kStep)
    if (theorem_bounds(s, varpi, 1).cond12) return "raise threshold to " + rounded_up(s.beta);
  return "no larger threshold is enough: take more rounds";
}

/// Theorem 1, and what is left of it with the detector.
void add_error_bounds(Check& c, const TheoremBounds& bounds, const InformedBound* informed) {
  if (informed == nullptr || bounds.cond12) {
    c.quantities.push_back(
        {"uniform bound", bounds.thm1_item2, "||error|| for all t >= 1, theorem 1 item 2"});
    c.quantities.push_back(
        {"asymptotic bound", bounds.thm1_item3, "limsup ||error||, theorem 1 item 3, in exact arithmetic"});
    return;
  }
  const bool known = !std::isnan(informed->uniform);
  const std::string why =
      known ? "also of agents that have proved all s attackers and no longer clip"
            : "none is known for agents that have proved all s attackers: they no longer clip "
              "and may overshoot (radius " +
                  text(informed->spectral_radius) + ", needed below 1)";
  c.quantities.push_back({"uniform bound", informed->uniform, "||error|| for all t >= 1, " + why});
  c.quantities.push_back(
      {"asymptotic bound", informed->asymptotic, "limsup ||error||, in exact arithmetic, " + why});
  c.quantities.push_back({"uniform bound, testing sensors", bounds.thm1_item2,
                          "theorem 1 item 2, of agents that have not proved all s attackers yet"});
  c.quantities.push_back({"asymptotic bound, testing sensors", bounds.thm1_item3,
                          "theorem 1 item 3, of agents that have not proved all s attackers yet"});
}

void add_bounds(Check& c, const Setting& s, double varpi_value, double tau0_value, const Interval& thresholds,
                const InformedBound* informed) {
  const auto k = constants(s);
  const auto points = fixed_points(s);
  const auto bounds = theorem_bounds(s, varpi_value, 1);
  const auto g = theorem5(s, tau0_value, varpi_value);
  c.conditions.push_back(
      {"eta0 (1 - F(eta0)) >= q0 (9)", k.cond9_margin, ">= 0", k.cond9,
       k.cond9 ? "the error stays bounded by theorem 1"
               : "the error would stay bounded by theorem 1; " + remedy9(s, points, thresholds)});
  c.conditions.push_back({"(beta - b_w - b_v)/a > rho_1 + p0 (12)", bounds.cond12_margin, "> 0",
                          bounds.cond12,
                          std::string("honest measurements are never clipped from t = 2 on (theorem 3)") +
                              (bounds.cond12 ? "" : "; " + remedy12(s, varpi_value)),
                          false});
  const bool vanishes = g.spectral_radius < 1.0;
  c.conditions.push_back({"spectral radius of G < 1 (theorem 5)", g.spectral_radius, "< 1", vanishes,
                          std::string("without noise the errors vanish once all attackers are proved") +
                              (vanishes            ? ""
                               : varpi_value < 1.0 ? "; take more rounds"
                                                   : "; add sensors: varpi must be below 1"),
                          false});
  c.quantities.push_back({"p0", k.p0, "limit of the disagreement bound (8)"});
  c.quantities.push_back({"q0", k.q0, "what noise, disagreement and attack add per step (8)"});
  c.quantities.push_back({"rho_lo", points.lo, "limit of the mean error bound (7)"});
  c.quantities.push_back({"rho_hi", points.hi, "largest initial error from which (7) does not grow"});
  add_error_bounds(c, bounds, informed);
  c.quantities.push_back({"unsaturated bound", bounds.thm3_item3,
                          "limsup ||error|| once no honest measurement is clipped, theorem 3 item 3"});
}

/// The adaptive threshold follows bounds that obey a linear recursion: they settle, or grow without end.
void add_adaptive(Check& c, const Setting& s, double varpi) {
  const AdaptiveStep none = adaptive_next(s, varpi, 0.0, 0.0);
  const AdaptiveStep from_rho = adaptive_next(s, varpi, 1.0, 0.0);
  const AdaptiveStep from_p = adaptive_next(s, varpi, 0.0, 1.0);
  Matrix step(2, 2);
  step << from_rho.rho - none.rho, from_p.rho - none.rho, from_rho.p - none.p, from_p.p - none.p;
  const double radius = spectral_radius(step);
  const bool settles = radius < 1.0 - kRadiusMargin;
  c.conditions.push_back(
      {"radius of the adaptive bounds < 1", radius, "< 1", settles,
       settles ? "threshold and bounds settle"
               : "threshold and bounds grow without end, nothing is limited in the long run; take a fixed "
                 "threshold, more rounds, or a smaller attacked"});
  const Vector limit = (Matrix::Identity(2, 2) - step).partialPivLu().solve(Vector{{none.rho, none.p}});
  c.quantities.push_back(
      {"asymptotic bound", settles ? limit.sum() : kNaN,
       settles ? "limsup ||error|| with the adaptive threshold" : "the bounds do not settle"});
}

/// How fast the excess fades that lost messages leave.
void add_recovery(Check& c, const certificate::Recovery& excess) {
  const double left = excess.left();
  const std::string window = std::to_string(excess.window());
  c.conditions.push_back({"excess after lost messages fades", left, "< 1", left < 1.0,
                          left < 1.0
                              ? "once messages arrive again, so much of it is left every " + window +
                                    " samples at most (theorem L)"
                              : "bounds after a lost message hold, but may stay large or grow: take more "
                                "rounds, or a smaller attacked",
                          false});
}

/// The data-free bound, at the start and for ever.
void add_table(Check& c, const Saturation::Params& p, const Model& model, const Network& network,
               const saturation::detail::Rates& rates) {
  auto options = saturation::detail::table_options(p, rates);
  options.detector = false;  // nothing here asks for theorem I
  const auto table = data_free(model, network, options);
  const bool gaussian = p.failure > 0.0;
  const std::string theorem = gaussian ? "theorem TG" : "theorem T";
  const double first = table.d.row(1).maxCoeff();
  const double last = table.d.row(table.d.rows() - 1).maxCoeff();
  const bool settles = std::isfinite(last);
  c.quantities.push_back({"table bound, first sample", first, "||error|| of any agent at t = 1, " + theorem});
  c.quantities.push_back(
      {"table bound", settles ? last : kNaN,
       settles ? "||error|| of any agent from t = " + std::to_string(table.d.rows() - 1) +
                     (gaussian ? " to " + std::to_string(p.horizon) : " on") + ", " + theorem +
                     ", whatever comes from " + amount(p.attacked, "sensor") + " and whoever is informed" +
                     (gaussian ? "; with probability " + text(p.failure) + " at most any of it is false" : "")
               : theorem + " gives no bound for ever: take more rounds, or a smaller attacked"});
  if (p.recovery) add_recovery(c, table.losses.excess);
}

}  // namespace

Check Saturation::check(const Params& p, const Model& model, const Network& network) {
  saturation::detail::require_parameters(p, model);
  Check c;
  c.conditions.push_back({"network undirected", network.directed() ? 0.0 : 1.0, "= 1", !network.directed(),
                          "averaging keeps the mean of the estimates"});
  c.conditions.push_back({"network connected", network.connected() ? 1.0 : 0.0, "= 1", network.connected(),
                          "estimates of all agents can agree"});
  if (network.directed() || !network.connected()) return c;
  const double s = p.attacked;
  const auto rates = saturation::detail::rates(network, p.step, p.rounds, p.chebyshev);
  c.quantities.push_back({"lambda_2", rates.lambda2, "algebraic connectivity of the network"});
  c.quantities.push_back({"lambda_max", rates.lambda_max, "largest eigenvalue of its Laplacian"});
  c.quantities.push_back({"alpha", rates.alpha, "consensus step"});
  c.quantities.push_back({"gamma", rates.gamma, "contraction of one plain round (8)"});
  c.quantities.push_back(
      {"contraction", rates.contraction, "what all rounds of a sample leave of a disagreement"});
  const bool bound_asked = !std::isnan(p.initial_error);
  const bool unit = scalar_unit_rows(model);
  c.conditions.push_back({"one measurement row of norm 1 per agent", unit ? 1.0 : 0.0, "= 1", unit,
                          row_advice(model), bound_asked});
  const Noise& noise = model.noise();
  const bool gaussian = p.failure > 0.0;
  const bool noise_known = gaussian
                               ? noise.process_covariance.size() > 0 && !noise.measurement_covariance.empty()
                               : !std::isnan(noise.process_bound) && noise.measurement_bound.size() > 0;
  c.conditions.push_back(
      gaussian ? Condition{"noise covariances known", noise_known ? 1.0 : 0.0, "= 1", noise_known,
                           "process_covariance and measurement_covariance of the model, for the table", true}
               : Condition{"noise bounds known", noise_known ? 1.0 : 0.0, "= 1", noise_known,
                           "process_bound and measurement_bound of the model, for all bounds", bound_asked});
  if (!unit) return c;
  if (gaussian) {
    if (noise_known) add_table(c, p, model, network, rates);
    return c;
  }
  const auto facts = saturation::detail::facts(model, p.attacked, true);
  const Matrix C = saturation::detail::sensor_rows(model);
  c.quantities.push_back({"||A||", facts.a, "largest growth of an error per step"});
  c.quantities.push_back(
      {"lambda_0", facts.lambda0.lower,
       facts.lambda0.exact
           ? "worst information of N - s sensors (6), exact"
           : "certified lower bound of (6), which is at most " + text(facts.lambda0.upper) +
                 "; the exact search was stopped after " +
                 amount(facts.lambda0.nodes, facts.lambda0.method == "directions" ? "cone" : "set")});
  c.quantities.push_back(
      {"varpi", facts.varpi,
       "largest growth of the mean error while no honest measurement is clipped (theorem 3)"});
  Setting setting = saturation::detail::setting(p, model, facts, rates);
  const double growth = facts.a * rates.contraction;
  const bool enough = condition11(setting);
  c.conditions.push_back({"lambda_0 > s (11)", facts.lambda0.lower, above(s), enough,
                          std::string("some threshold and rounds work for ||A|| near 1 (theorem 2)") +
                              (enough ? "" : "; " + remedy11(C, p.attacked)),
                          false});
  // With lambda_0 < s a plant that contracts (a < 1) always has some small threshold with (9).
  const double a_max = std::max(1.0, normA_max_exact(setting));
  c.conditions.push_back({"||A|| < max(1, N/(N - lambda_0 + s))", facts.a, "< " + six_digits(a_max),
                          facts.a < a_max - kRadiusMargin,
                          "some threshold, initial error and rounds satisfy (9) (exact, unlike theorem 2)",
                          false});
  const auto least = minimal_rounds(
      setting, p.chebyshev
                   ? std::function<double(int)>([&](int L) { return chebyshev_contraction(rates.gamma, L); })
                   : [&](int L) { return std::pow(rates.gamma, L); });
  c.conditions.push_back(
      {"||A|| gamma^L < 1", growth, "< 1", growth < 1.0,
       growth < 1.0 ? "the disagreement stays bounded"
       : least      ? "the disagreement would stay bounded; raise rounds to " + std::to_string(*least)
                    : "the disagreement would stay bounded; no number of rounds is enough for (9)",
       bound_asked});
  c.quantities.push_back(
      {"minimal rounds", least ? static_cast<double>(*least) : kNaN,
       least ? "fewest rounds for which some threshold satisfies (9)" : "no number of rounds is enough"});
  if (std::isnan(p.initial_error) || !noise_known) {
    c.quantities.push_back({"asymptotic bound", kNaN, "needs initial_error and both noise bounds"});
    return c;
  }
  const auto interval = beta_interval(setting);
  c.quantities.push_back({"threshold from", interval.lo, "least threshold with (9) for this initial error"});
  c.quantities.push_back({"threshold to", interval.hi, "largest threshold with (9) for this initial error"});
  if (p.table && (p.adaptive || std::isfinite(p.threshold))) add_table(c, p, model, network, rates);
  if (p.adaptive) add_adaptive(c, setting, facts.varpi);
  if (!(growth < 1.0)) return c;
  if (p.adaptive || !std::isfinite(p.threshold)) return c;
  const auto tau = tau0(C, model.A(), p.attacked, usual_limits(C.rows(), C.cols()));
  const auto informed = p.detector
                            ? informed_bound(setting, tau.upper, facts.varpi, spread_of(network, p.rounds))
                            : InformedBound{};
  add_bounds(c, setting, facts.varpi, tau.upper, interval, p.detector ? &informed : nullptr);
  return c;
}

}  // namespace garrison
