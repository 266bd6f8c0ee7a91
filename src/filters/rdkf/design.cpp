// SPDX-License-Identifier: Apache-2.0

#include "core/solvers.hpp"
#include "garrison/filters/rdkf/analysis.hpp"
#include "garrison/filters/rdkf/filter.hpp"
#include "garrison/filters/rdkf/ipopt_step.hpp"
#include "garrison/filters/rdkf/part_design.hpp"
#include "penalties.hpp"

namespace garrison {
namespace rdkf {

Penalty penalty_named(const std::string& name) {
  return name == "huber"   ? Penalty::huber
         : name == "l1"    ? Penalty::l1
         : name == "group" ? Penalty::group
                           : Penalty::norm;
}

namespace {

Matrix inverse(const Matrix& S) { return Eigen::LLT<Matrix>(S).solve(Matrix::Identity(S.rows(), S.cols())); }

/// Below this whitened residual of the prediction the dual solution stays inside of the ball: |u| <= |rho| /
/// min d.
double quiet_level(const StepFactors& f, double lambda) {
  double least = kInfinity;
  for (int i = 0; i < f.outputs(); ++i) least = std::min(least, f.d[static_cast<std::size_t>(i)]);
  return least == 0.0 ? 0.0 : lambda * least;
}

void factor(AgentGains& a, const Setting& s, const Matrix& Q, std::size_t i, const Gains& g) {
  switch (g.penalty) {
    case Penalty::norm:
    case Penalty::huber:
      a.step = step_factors(s.whitener[i], s.C[i], Q, g.penalty);
      a.quiet_level = quiet_level(a.step, g.price.lambda);
      break;
    case Penalty::l1:
      a.box = box_factors(s.whitener[i], s.C[i], Q);
      break;
    case Penalty::group:
      for (const int j : a.heard) {
        const auto k = static_cast<std::size_t>(j);
        a.blocks.push_back(step_factors(s.whitener[k], s.C[k], Q, Penalty::norm));
      }
      break;
  }
  if (g.ipopt) a.Q = Q;
}

/// What the step needs where some outputs of a sensor are missing.
void keep_rows(AgentGains& a, const Setting& s, const Matrix& Q, std::size_t i, const Gains& g) {
  const std::vector<int> own{static_cast<int>(i)};
  bool several = false;
  for (const int j : g.penalty == Penalty::group ? a.heard : own) {
    const auto k = static_cast<std::size_t>(j);
    const bool single = s.C[k].rows() <= 1;
    a.sensors.push_back(single ? SensorRows{} : SensorRows{s.Sv[k], s.C[k]});
    several = several || !single;
  }
  if (several) a.L = Eigen::LLT<Matrix>(Q).matrixL();
}

/// Fills g.agents; the rest of g is set.
void design_agents(Gains& g, const Setting& s, Borders* borders = nullptr) {
  SteadyOptions options;
  options.borders = borders;
  const SteadyState steady = steady_state(s, options);
  for (std::size_t i = 0; i < s.C.size(); ++i)
    g.most_outputs = std::max(g.most_outputs, static_cast<int>(s.C[i].rows()));
  if (g.penalty == Penalty::group && g.most_outputs > kMostGroupOutputs)
    refuse("rdkf.penalty", "\"group\" with " + amount(g.most_outputs, "output") + " of one agent",
           "at most " + std::to_string(kMostGroupOutputs), "split the sensor, or take penalty \"huber\"");
  for (std::size_t i = 0; i < s.C.size(); ++i) {
    AgentGains a;
    a.heard = s.neighbours[i];
    a.J = Packed(Eigen::LLT<Matrix>(steady.Pbar[i]).solve(s.A));
    const Matrix F = inverse(steady.Q[i]) / static_cast<double>(a.heard.size());
    a.F = Packed(0.5 * (F + F.transpose()));
    factor(a, s, steady.Q[i], i, g);
    keep_rows(a, s, steady.Q[i], i, g);
    a.deviation_bound = deviation_bound(s, steady, static_cast<int>(i), g.price.lambda, g.penalty);
    if (g.bounded) {
      a.reach = prior_error_norms(s, steady, static_cast<int>(i));
      a.rounding = 4.0 * s.states() * std::numeric_limits<double>::epsilon() * F.norm();
    }
    g.agents.push_back(std::move(a));
  }
}

}  // namespace
}  // namespace rdkf

void Rdkf::require_fitting(const Params& p) {
  if (p.smoothing > 0.0 && p.penalty != "norm")
    refuse("rdkf.smoothing", text(p.smoothing) + " with penalty \"" + p.penalty + "\"",
           "0, or penalty \"norm\"");
  if (p.solver != "ipopt") return;
  if (p.penalty != "norm")
    refuse("rdkf.solver", "\"ipopt\" with penalty \"" + p.penalty + "\"", "\"exact\", or penalty \"norm\"");
  rdkf::require_ipopt();
}

namespace {

/// What does not depend on the agents.
Rdkf::Gains common(const Rdkf::Params& p, const Model& model) {
  Rdkf::require_fitting(p);
  Rdkf::Gains g;
  g.penalty = rdkf::penalty_named(p.penalty);
  g.price = {p.weight, p.smoothing};
  g.ipopt = p.solver == "ipopt";
  g.bounded = !std::isnan(p.initial_error);
  if (g.bounded) {
    g.initial_error = p.initial_error;
    g.process_bound = model.noise().process_bound;
    if (std::isnan(g.process_bound))
      refuse("process_bound", "none", "a bound on |w|",
             "the run-time error bound needs it; 0 when there is no noise");
  }
  return g;
}
Rdkf::Gains common() {
  Rdkf::Gains g;
  g.penalty = rdkf::Penalty::huber;
  g.price = {kInfinity, 0.0};
  return g;
}
/// The unprotected filter has no bound on a deviation.
void unbound(Rdkf::Gains& g) {
  for (auto& agent : g.agents) agent.deviation_bound = kNaN;
}

}  // namespace

Rdkf::Gains Rdkf::design(const Params& p, const Model& model, const Network& network) {
  Gains g = common(p, model);
  rdkf::design_agents(g, rdkf::setting(model, network));
  return g;
}

Rdkf::Gains Dkf::design(const Params&, const Model& model, const Network& network) {
  Gains g = common();
  rdkf::design_agents(g, rdkf::setting(model, network));
  unbound(g);
  return g;
}

Rdkf::Gains rdkf::design_part(const Rdkf::Params& p, const Model& model, const Network& network,
                              Borders& borders) {
  Rdkf::Gains g = common(p, model);
  if (g.penalty == Penalty::group)
    refuse("rdkf.penalty", "\"group\" in a part of a network", "another penalty",
           "it needs the sensors of agents of other parts");
  design_agents(g, part_setting(model, network), &borders);
  return g;
}

Rdkf::Gains rdkf::design_part(const Dkf::Params&, const Model& model, const Network& network,
                              Borders& borders) {
  Rdkf::Gains g = common();
  design_agents(g, part_setting(model, network), &borders);
  unbound(g);
  return g;
}

}  // namespace garrison
