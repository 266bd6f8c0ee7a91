// SPDX-License-Identifier: Apache-2.0
// `garrison check` for the structural filter.
#include <algorithm>
#include <cmath>

#include "garrison/analysis/modes.hpp"
#include "garrison/analysis/structure/system.hpp"
#include "garrison/filters/structural/detection.hpp"
#include "garrison/filters/structural/filter.hpp"
#include "garrison/filters/structural/gains.hpp"

namespace garrison {
namespace {

using structural::Setting;

structure::Sensors sensors_of(const Setting& s) {
  structure::Sensors all(static_cast<std::size_t>(s.N()));
  for (Eigen::Index i = 0; i < s.N(); ++i)
    for (Eigen::Index k = 0; k < s.n(); ++k)
      if (s.C(i, k) != 0.0) all[static_cast<std::size_t>(i)].push_back(static_cast<int>(k));
  return all;
}

void add_structure(Check& c, const Setting& s) {
  const structure::System system(structure::Pattern::of(s.A));
  const auto sensors = sensors_of(s);
  const auto seen = system.observability(sensors);
  c.conditions.push_back({"structurally observable", seen.holds() ? 1.0 : 0.0, "= 1", seen.holds(),
                          "almost all systems with these zeros are observable by all sensors together",
                          false});
  const auto necessary = system.necessary(sensors);
  c.quantities.push_back({"structural rank", static_cast<double>(system.parts().structural_rank()),
                          "largest rank of a matrix with the zeros of A"});
  c.quantities.push_back({"necessary agents",
                          static_cast<double>(std::count(necessary.begin(), necessary.end(), 1)),
                          "agents whose loss alone ends structural observability"});
  const auto types = system.classes(sensors);
  const auto add = [&](const char* name, structure::AgentClass kind, const char* meaning) {
    c.quantities.push_back(
        {name, static_cast<double>(std::count(types.begin(), types.end(), kind)), meaning});
  };
  add("alpha agents", structure::AgentClass::alpha, "agents that measure a state of a contraction");
  add("beta agents", structure::AgentClass::beta, "agents that measure a state of a parent component");
  add("gamma agents", structure::AgentClass::gamma, "agents that measure a state of neither");
}

void add_errors(Check& c, const Setting& s, const structural::GainMatrices& K, double false_alarm) {
  const auto x = structural::stationary(s, K);
  c.quantities.push_back({"mean square error", x.Q.trace() / static_cast<double>(s.N()),
                          "stationary, per agent, summed over the states; exact"});
  c.quantities.push_back({"largest residual deviation", x.residual_std.maxCoeff(), "exact, over agents"});
  const auto bound = structural::covariance_bound(s, K, false);
  c.conditions.push_back({"|Ahat|_2 < 1 (10)", bound.b, "< 1", bound.b < 1.0,
                          "the paper's bound exists; the exact covariance does not need it", false});
  c.quantities.push_back({"bound of |Q| (10)", std::isfinite(bound.bound) ? bound.bound : kNaN,
                          "with the corrected noise term"});
  double harm = 0.0;
  for (const auto& e : structural::exposure(s, x, false_alarm, 0.99)) harm = std::max(harm, e.largest_harm);
  c.quantities.push_back({"harm of an unseen constant attack", harm,
                          "largest steady mean error that is detected with less than 99 % per sample"});
}

}  // namespace

Check Structural::check(const Params& p, const Model& model, const Network& network) {
  Check c;
  const Setting s = setting(p, model, network);
  add_structure(c, s);
  const Visibility modes = visibility(model.A(), model.stacked(), 1.0);
  c.conditions.push_back({"unstable modes that no agent surely sees",
                          static_cast<double>(modes.unseen.size() + modes.unclear.size()), "= 0",
                          modes.all_seen(),
                          "the system is detectable by all sensors together; " + modes.text()});
  c.quantities.push_back(
      {"agents that could drift unseen", static_cast<double>(undetectable_agents(model).size()),
       "alone on a mode that does not decay: without limit, and no detector of any kind sees it"});
  const structure::Pattern mixing = structure::Pattern::of(s.W);
  const bool strong = structure::strong_components(mixing).count == 1;
  c.conditions.push_back({"estimates reach everybody", strong ? 1.0 : 0.0, "= 1", strong,
                          "W is strongly connected (lemma 2; sufficient with full sharing, not necessary)",
                          false});
  const double least = s.W.diagonal().minCoeff();
  c.conditions.push_back(
      {"least self-weight W_ii", least, "> 0", least > 0.0, "lemma 2; small ones stabilise more", false});
  const bool known = s.E.size() != 0 && s.R.size() != 0;
  if (p.gain.empty() && (!known || !modes.all_seen())) return c;
  structural::GainMatrices K;
  double rho = kNaN;
  if (p.gain.empty()) {
    try {
      auto designed = structural::design_gains(s, p.design);
      K = std::move(designed.K);
      rho = designed.rho;
    } catch (const DesignInfeasible& e) {
      c.conditions.push_back({"spectral radius of the error matrix", kNaN, "< 1", false, e.what()});
      return c;
    }
  } else {
    K = gains_of(p, s);
    rho = structural::error_radius(s, K);
  }
  c.conditions.push_back({"spectral radius of the error matrix", rho, "< 1", rho < 1.0,
                          "the error stays bounded in mean square (lemma 4)"});
  constexpr Eigen::Index kExact = 1200;
  if (known && rho < 1.0 && s.N() * s.n() <= kExact) add_errors(c, s, K, p.false_alarm);
  return c;
}

}  // namespace garrison
