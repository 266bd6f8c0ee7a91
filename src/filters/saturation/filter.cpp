// SPDX-License-Identifier: Apache-2.0
// Design: from parameters, model and network to what the agents need.
#include "garrison/filters/saturation/filter.hpp"

#include "core/solvers.hpp"
#include "facts.hpp"
#include "garrison/filters/saturation/constants.hpp"

namespace garrison {
namespace {

using saturation::detail::Facts;

/// What every run-time bound rests on; the first thing that is missing is named. Noise within bounds, or
/// Gaussian.
void require_bound_assumptions(const Model& model, bool gaussian) {
  const Noise& noise = model.noise();
  if (!gaussian && (std::isnan(noise.process_bound) || noise.measurement_bound.size() == 0))
    refuse("model", "no process_bound or no measurement_bound", "both",
           "an error bound needs bounded noise; leave initial_error out to run without, or take a table with "
           "failure > 0 for Gaussian noise");
  if (gaussian && (noise.process_covariance.size() == 0 || noise.measurement_covariance.empty()))
    refuse("model", "no process_covariance or no measurement_covariance", "both",
           "saturation.failure > 0 means Gaussian noise of these covariances");
  for (int i = 0; i < model.agents(); ++i) {
    if (model.outputs(i) > 1)
      refuse("C[" + std::to_string(i) + "]", amount(model.outputs(i), "row"), "at most one row per agent",
             "an error bound needs scalar sensors: split_outputs gives each row an agent of its own");
    if (model.outputs(i) == 0) continue;
    const double length = model.C(i).stableNorm();
    if (length == 0.0)
      refuse("C[" + std::to_string(i) + "]", "zeros", "a row of unit length",
             "the sensor of agent " + std::to_string(i) +
                 " sees nothing of the state: take its row away (C[" + std::to_string(i) +
                 "] = [], an agent without sensors)");
    if (std::abs(length - 1.0) > 1e-9)
      refuse("C[" + std::to_string(i) + "]", "a row of length " + text(length), "a row of unit length",
             "divide the row, its measurements and their noise by " + text(length) +
                 " (saturation.normalise_rows does)");
  }
}

}  // namespace

Saturation::Gains Saturation::design(const Params& p, const Model& model, const Network& network) {
  saturation::detail::require_parameters(p, model);
  if (network.directed())
    refuse("network", "a directed one", "an undirected one",
           "averaging keeps the mean only on undirected graphs");
  network.require_connected();
  Gains g;
  g.rounds = p.rounds;
  g.detector = p.detector;
  g.sharp_index = p.detector_index == "t+1";
  g.adaptive = p.adaptive;
  g.accuse_missing = p.accuse_missing;
  g.beta = p.adaptive ? kInfinity : p.threshold;
  const bool gaussian = p.failure > 0.0;
  g.bounded = !gaussian && !std::isnan(p.initial_error) && (p.adaptive || std::isfinite(p.threshold));
  const bool spectrum_needed = std::isnan(p.step) || p.chebyshev || g.bounded ||
                               !saturation::detail::surely_contracts(network, p.step);
  const auto rates = spectrum_needed ? saturation::detail::rates(network, p.step, p.rounds, p.chebyshev)
                                     : saturation::detail::Rates{.alpha = p.step, .omega = {}};
  g.alpha = rates.alpha;
  g.omega = rates.omega;
  if (!g.bounded && !gaussian) return g;
  require_bound_assumptions(model, gaussian);
  if (p.table) g.table = saturation::data_free(model, network, saturation::detail::table_options(p, rates));
  if (gaussian) {
    g.setting.agents = model.agents();
    g.setting.attacked = p.attacked;
    return g;
  }
  const Facts facts = saturation::detail::facts(model, p.attacked, p.adaptive);
  g.setting = saturation::detail::setting(p, model, facts, rates);
  if (p.adaptive) {
    g.varpi = facts.varpi;
    return g;
  }
  const auto constants = saturation::constants(g.setting);
  g.p0 = constants.p0;
  g.q0 = constants.q0;
  return g;
}

Saturation::Gains Saturation::part(const Gains& gains, int id, std::span<const int>) {
  Gains part = gains;
  part.table = gains.table.of(id);
  return part;
}

void Saturation::check_start(const Gains& g, const Matrix& x0) {
  if (!g.bounded) return;
  for (Eigen::Index i = 1; i < x0.cols(); ++i)
    if (x0.col(i) != x0.col(0))
      refuse("start", "different initial estimates for agents 0 and " + std::to_string(i),
             "the same one for all agents",
             "the error bound and the detector of Algorithm 2 rest on it; leave initial_error out to run "
             "without");
}

}  // namespace garrison
