// SPDX-License-Identifier: Apache-2.0

#include "garrison/analysis/modes.hpp"
#include "garrison/core/spectrum.hpp"
#include "garrison/filters/rdkf/analysis.hpp"
#include "garrison/filters/rdkf/filter.hpp"
#include "penalties.hpp"

namespace garrison {
namespace {

using namespace rdkf;

/// Saturated steps in a row after which a majority is worth a warning.
constexpr int kLong = 20;
/// Radius of A above which the plant counts as unstable: that of a rotation is 1 up to rounding.
constexpr double kUnstable = 1.0 + 1e-9;

/// Existence of the covariances (theorem III.1). False: nothing else can be computed.
bool existence(Check& c, const Model& model, const Network& network) {
  const bool connected = network.connected();
  const Visibility modes = visibility(model.A(), model.stacked(), 1.0);
  const bool seen = modes.all_seen();
  const Noise& noise = model.noise();
  const bool known = (noise.process_covariance.size() != 0 || !noise.agent_process_covariance.empty()) &&
                     (!noise.measurement_covariance.empty() || model.total_outputs() == 0);
  c.conditions.push_back({"connected network", connected ? 1.0 : 0.0, "= 1", connected,
                          "information of every sensor reaches every agent"});
  c.conditions.push_back({"(A, C) detectable", seen ? 1.0 : 0.0, "= 1", seen,
                          "equation (5) has a solution (theorem III.1); " + modes.text()});
  c.conditions.push_back({"covariances known", known ? 1.0 : 0.0, "= 1", known,
                          "process_covariance and measurement_covariance of the model"});
  return connected && seen && known;
}

void fixed_point(Check& c, const SteadyState& steady) {
  double trace = 0.0;
  for (const Matrix& P : steady.P) trace = std::max(trace, P.trace());
  c.quantities.push_back({"sweeps", static_cast<double>(steady.sweeps), "of (5) until it settled"});
  c.quantities.push_back({"last change", steady.change, "relative, in the last sweep of (5)"});
  c.quantities.push_back(
      {"largest trace of P", trace, "variance of the worst agent, without attack, of (7)"});
}

void rates(Check& c, const Model& model, const Constants& k) {
  const double a = spectral_radius(model.A());
  c.quantities.push_back({"radius of A", a, "spectral radius of the plant"});
  c.conditions.push_back({"gamma < 1", k.rate, "< 1", k.rate < 1.0,
                          "errors of (7) shrink: V_k <= gamma V_{k-1} (not in the paper)"});
  c.quantities.push_back({"radius of (7)", k.dkf_error_radius, "per step, of the error without attack"});
}

void under_attack(Check& c, const Model& model, const Constants& k) {
  const double open = k.prior_error_radius;
  const bool bounded = open < 1.0 - 1e-9;
  c.conditions.push_back({"radius without measurements < 1", open, "< 1", bounded,
                          bounded ? "attacks for ever keep the error bounded"
                                  : "no bound for persistent attacks: radius = " + text(open),
                          false});
  c.quantities.push_back({"resiliency bound (10)", k.resiliency_bound.maxCoeff(),
                          "two estimates of one step, whatever was measured, worst agent"});
  c.quantities.push_back(
      {"deviation bound", k.prior_deviation_bound.maxCoeff(),
       "estimate from the fused prediction in one step, whatever was measured, worst agent"});
  const double persistent = bounded ? k.persistent_bound.maxCoeff() : kNaN;
  const std::string none = "no bound for persistent attacks: radius = " + text(open);
  c.quantities.push_back(
      {"persistent bound", persistent,
       bounded ? "error of a run without noise that starts exactly, under any attack for ever, worst agent"
               : none});
  c.quantities.push_back(
      {"persistent shift", 2.0 * persistent,
       bounded ? "estimate from that of the same run without attack (same noise, same start), under any "
                 "attack for ever, worst agent"
               : none});
  c.quantities.push_back({"basin", std::isinf(k.level.refined) ? kNaN : k.level.refined,
                          std::isnan(k.level.refined) ? "known for penalty \"norm\" only"
                          : std::isinf(k.level.refined)
                              ? "nobody has a sensor that counts"
                              : "a start with max e'P^-1 e at most this converges like gamma without attack "
                                "(theorem III.3, corrected and refined)"});
  if (spectral_radius(model.A()) > kUnstable)
    c.quantities.push_back(
        {"basin of theorem III.3", k.level.corrected,
         "unstable plant: a start far outside may diverge, without any error raised; this is the "
         "level with lambda instead of the printed 2 lambda, which is wrong"});
}

}  // namespace

Check Rdkf::check(const Params& p, const Model& model, const Network& network) {
  require_fitting(p);
  Check c;
  if (!existence(c, model, network)) return c;
  const Setting s = setting(model, network);
  const SteadyState steady = steady_state(s);
  const Constants k = constants(s, steady, p.weight, penalty_named(p.penalty));
  fixed_point(c, steady);
  rates(c, model, k);
  under_attack(c, model, k);
  return c;
}

Check Dkf::check(const Params&, const Model& model, const Network& network) {
  Check c;
  if (!existence(c, model, network)) return c;
  const Setting s = setting(model, network);
  const SteadyState steady = steady_state(s);
  fixed_point(c, steady);
  rates(c, model, constants(s, steady, 0.0, Penalty::norm));
  return c;
}

std::vector<std::string> Rdkf::warnings(const Model& model, const VerdictLog& log) {
  if (log.verdict.empty() || spectral_radius(model.A()) <= kUnstable) return {};
  int trials = 0;
  int longest = 0;
  for (int trial = 0; trial < log.trials; ++trial) {
    int row = 0;
    int most = 0;
    for (int t = 0; t < log.times; ++t) {
      const auto at = (static_cast<std::size_t>(trial) * static_cast<std::size_t>(log.times) +
                       static_cast<std::size_t>(t)) *
                      static_cast<std::size_t>(log.agents);
      int pulled = 0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(log.agents); ++i)
        pulled += log.verdict[at + i] == static_cast<std::uint8_t>(Verdict::suspected) ? 1 : 0;
      row = 2 * pulled > log.agents ? row + 1 : 0;
      most = std::max(most, row);
    }
    trials += most >= kLong ? 1 : 0;
    longest = std::max(longest, most);
  }
  if (trials == 0) return {};
  return {"most agents were saturated for " + amount(longest, "step") + " in a row (" +
          std::to_string(trials) + " of " + amount(log.trials, "trial") +
          ") and the plant is unstable: the estimates may diverge; start closer, raise the weight, or "
          "protect more sensors"};
}

}  // namespace garrison
