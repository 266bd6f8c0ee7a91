// SPDX-License-Identifier: Apache-2.0
#include "facts.hpp"

#include <algorithm>
#include <cmath>

#include "core/solvers.hpp"
#include "garrison/kernel/chebyshev.hpp"

namespace garrison::saturation::detail {
namespace {
constexpr double kCleanGamma = 1e-14;  // complete graphs: rounding leaves 1e-17 where gamma is 0
}

namespace {
/// What a table for Gaussian noise goes with.
void require_gaussian(const Saturation::Params& p) {
  // Agents and samples share it; below that quantiles do not exist.
  constexpr double kLeast = 1e-200;
  if (!(p.failure >= kLeast && p.failure < 1.0))
    refuse("saturation.failure", text(p.failure), "a probability in [1e-200, 1) beside horizon",
           "1e-6, say; for noise within bounds leave out failure and horizon");
  if (p.horizon < 1)
    refuse("saturation.horizon", std::to_string(p.horizon), "a number of samples >= 1 with failure",
           "all of them share the failure probability");
  if (!p.table)
    refuse("saturation.failure", text(p.failure), "0 without table", "it is the table's: set table = true");
  if (p.adaptive)
    refuse("saturation.adaptive", "true", "false with failure",
           "the adaptive threshold outlives the horizon, and needs noise bounds then");
  if (p.recovery)
    refuse("saturation.recovery", "true", "false with failure",
           "relayed bounds need noise bounds; a certificate of the data does not");
}
}  // namespace

void require_parameters(const Saturation::Params& p, const Model& model) {
  if (std::isnan(p.threshold) && !p.adaptive)
    refuse("saturation.threshold", "no value, or nan", "a number > 0 (inf = never saturate)",
           "or set adaptive = true");
  if (!std::isnan(p.threshold) && p.adaptive)
    refuse("saturation.threshold", text(p.threshold), "nothing together with adaptive = true",
           "the adaptive threshold follows from the noise bounds and initial_error");
  if (p.adaptive && p.detector)
    refuse("saturation.detector", "true", "false together with adaptive = true",
           "with the adaptive threshold, an innovation above it already proves an attack");
  if (p.attacked > model.agents())
    refuse("saturation.attacked", std::to_string(p.attacked),
           "at most the number of agents, " + std::to_string(model.agents()));
  if ((p.detector || p.adaptive) && std::isnan(p.initial_error))
    refuse("saturation.initial_error", "no value, or nan", "a number > 0",
           std::string(p.detector ? "the detector" : "the adaptive threshold") + " needs error bounds");
  const bool bounded = !std::isnan(p.initial_error) && (p.adaptive || std::isfinite(p.threshold));
  if (p.table && !bounded)
    refuse("saturation.table", "true", "false without initial_error and a finite threshold",
           "the table starts from a bound on the initial error");
  if (p.failure > 0.0 || p.horizon > 0) require_gaussian(p);
  if (p.recovery && !p.table)
    refuse("saturation.recovery", "true", "false without table",
           "it goes on from the table: set table = true");
  if (p.accuse_missing && !p.detector)
    refuse("saturation.accuse_missing", "true", "false without detector",
           "a missing measurement is a proof for the detector; give detector = true too");
  if (p.detector && !bounded)
    refuse("saturation.threshold", text(p.threshold), "a finite number with the detector",
           "thresholds build on it");
}

bool surely_contracts(const Network& network, double step) {
  return step > 1e-9 && step * network.max_degree() < 1.0;  // twice the degree is above all eigenvalues
}

Rates rates(const Network& network, double step, int rounds, bool chebyshev) {
  Rates r;
  const auto [lambda2, lambda_max] = network.laplacian_spectrum();
  r.lambda2 = lambda2;
  r.lambda_max = lambda_max;
  r.gamma = 0.0;
  if (network.agents() > 1) {
    r.alpha = std::isnan(step) ? 2.0 / (lambda2 + lambda_max) : step;
    // The paper's gamma in the form that has no cancellation; any other step has its own.
    r.gamma = std::isnan(step) ? (lambda_max - lambda2) / (lambda_max + lambda2)
                               : std::max(std::abs(1.0 - step * lambda2), std::abs(1.0 - step * lambda_max));
    if (r.gamma < kCleanGamma) r.gamma = 0.0;
    if ((rounds > 0 || !std::isnan(step)) && r.gamma >= 1.0)
      refuse("saturation.step", text(r.alpha), "a number in (0, " + text(2.0 / lambda_max) + ")",
             "other steps make the consensus rounds diverge; leave it out for the best one");
  }
  r.contraction = chebyshev ? chebyshev_contraction(r.gamma, rounds) : std::pow(r.gamma, rounds);
  if (chebyshev) r.omega = chebyshev_weights(r.gamma, rounds);
  return r;
}

Matrix sensor_rows(const Model& model) {
  Matrix C = Matrix::Zero(model.agents(), model.states());
  for (int i = 0; i < model.agents(); ++i)
    if (model.outputs(i) == 1) C.row(i) = model.C(i);
  return C;
}

Facts facts(const Model& model, int attacked, bool with_varpi) {
  Facts f;
  const Matrix C = sensor_rows(model);
  f.a = Eigen::JacobiSVD<Matrix>(model.A()).singularValues()(0);
  const SubsetLimits limits = usual_limits(C.rows(), C.cols());
  f.lambda0 = lambda0(C, attacked, limits);
  if (!with_varpi) return f;
  f.varpi = f.a * (1.0 - f.lambda0.lower / model.agents());
  if (const auto exact = varpi_enumerated(C, model.A(), attacked, limits))
    f.varpi = std::min(f.varpi, exact->upper);
  return f;
}

DataFreeOptions table_options(const Saturation::Params& p, const Rates& rates) {
  return {.attacked = p.attacked,
          .initial_error = p.initial_error,
          .beta = p.adaptive ? kNaN : p.threshold,
          .alpha = rates.alpha,
          .omega = rates.omega,
          .rounds = p.rounds,
          .detector = p.detector,
          .recovery = p.recovery,
          .failure = p.failure,
          .horizon = p.horizon};
}

Setting setting(const Saturation::Params& p, const Model& model, const Facts& facts, const Rates& rates) {
  Setting s;
  s.agents = model.agents();
  s.a = facts.a;
  s.lambda0 = facts.lambda0.lower;
  s.contraction = rates.contraction;
  s.attacked = p.attacked;
  s.beta = p.adaptive ? kNaN : p.threshold;
  s.eta0 = p.initial_error;
  s.b_w = model.noise().process_bound;
  s.b_v = model.measurement_bound();
  return s;
}

}  // namespace garrison::saturation::detail
