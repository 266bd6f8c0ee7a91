// SPDX-License-Identifier: Apache-2.0
// Design.
#include "garrison/filters/platoon/filter.hpp"

#include <algorithm>
#include <cmath>

#include "facts.hpp"
#include "garrison/filters/platoon/partition.hpp"
#include "garrison/filters/platoon/theorems.hpp"
#include "garrison/filters/platoon/world.hpp"

namespace garrison {
namespace platoon::detail {
namespace {

/// Adds pairs (vehicle, sensor) to the priors.
void add_pairs(const char* which, const std::vector<double>& pairs, std::vector<int> Prior::* set, int N,
               std::vector<Prior>& priors) {
  const std::string owner = std::string("platoon.prior_") + which;
  if (pairs.size() % 2 != 0) refuse(owner, amount(pairs.size(), "number"), "pairs vehicle, sensor");
  for (std::size_t k = 0; k < pairs.size(); k += 2) {
    for (const double id : {pairs[k], pairs[k + 1]})
      if (!(id >= 0.0) || !(id < N) || id != std::floor(id))
        refuse(owner, text(id), "a vehicle or sensor label in 0.." + std::to_string(N - 1));
    auto& ids = priors[static_cast<std::size_t>(pairs[k])].*set;
    const int id = static_cast<int>(pairs[k + 1]);
    const auto at = std::lower_bound(ids.begin(), ids.end(), id);
    if (at == ids.end() || *at != id) ids.insert(at, id);
  }
}

std::vector<Prior> priors_of(const Platoon::Params& p, int N) {
  if (p.prior_attacked.empty() && p.prior_suspected.empty() && p.prior_free.empty()) return {};
  std::vector<Prior> priors(static_cast<std::size_t>(N));
  add_pairs("attacked", p.prior_attacked, &Prior::attacked, N, priors);
  add_pairs("suspected", p.prior_suspected, &Prior::suspected, N, priors);
  add_pairs("free", p.prior_free, &Prior::free, N, priors);
  // Vehicles share what they know, so the sets must agree over all of them.
  std::vector<char> attacked(static_cast<std::size_t>(N), 0);
  int count = 0;
  for (const Prior& prior : priors)
    for (const int id : prior.attacked)
      if (attacked[static_cast<std::size_t>(id)]++ == 0) ++count;
  for (int i = 0; i < N; ++i)
    for (const int id : priors[static_cast<std::size_t>(i)].free)
      if (attacked[static_cast<std::size_t>(id)] != 0)
        refuse("platoon.prior_free",
               "sensor " + std::to_string(id) + " (given to vehicle " + std::to_string(i) + ")",
               "attacked and free sets that do not intersect",
               "it is in a prior attacked set too: remove it from one of both");
  if (count > p.attacked)
    refuse("platoon.prior_attacked", amount(count, "sensor"),
           "at most b = attacked = " + std::to_string(p.attacked), "raise attacked");
  return priors;
}

}  // namespace

namespace {

bool only_observes(const Platoon::Params& p) {
  return p.reference.empty() && std::isnan(p.gs) && std::isnan(p.gv);
}

/// Bounds on the noise: of the length, of the entries, or both.
void set_noise(const Platoon::Params& p, Setting& s) {
  const double given[4] = {p.absolute_position_noise, p.absolute_velocity_noise, p.relative_position_noise,
                           p.relative_velocity_noise};
  std::copy_n(given, 2, s.absolute);
  std::copy_n(given + 2, 2, s.relative);
  const bool all = std::none_of(given, given + 4, [](double bound) { return std::isnan(bound); });
  if (std::isnan(p.measurement_noise) && !all)
    refuse(
        "platoon.measurement_noise", "none",
        "a bound on the length of every noise vector, in m and m/s, or all four of absolute_position_noise, "
        "absolute_velocity_noise, relative_position_noise and relative_velocity_noise");
  s.mu = std::isnan(p.measurement_noise) ? kInfinity : p.measurement_noise;
  if (std::isnan(s.mu) || s.mu < 0.0) return;  // refused with the rest
  s.mu = std::max(absolute_noise(s).norm, relative_noise(s).norm);
}

/// Recorded inputs of vehicle i stand in the last of its columns.
bool records_inputs(const Model& model) { return Outputs::of(0, model.outputs(0)).input; }

/// Unknown inputs are one more disturbance of the velocity.
void set_input(const Platoon::Params& p, const Model& model, Setting& s) {
  s.eps = s.eps_position = p.process_noise;
  s.input = p.input_bound;
  if (!only_observes(p)) {
    if (!std::isnan(p.input_bound))
      refuse("platoon.input_bound", text(p.input_bound), "none, because reference, gs and gv are given",
             "the vehicles do what the filter commands; leave those three out to observe only");
  } else if (!std::isnan(p.input_bound)) {
    s.eps += s.period * p.input_bound;
  } else if (!records_inputs(model)) {
    refuse("platoon.reference, gs, gv", "none of them",
           "all three to control the vehicles; or, to observe only, recorded inputs (platoon.model with "
           "inputs) or "
           "input_bound");
  }
}

Formation formation_of(const Platoon::Params& p, const Setting& s) {
  if (only_observes(p)) return {};
  const auto require = [](bool given, const char* which, const char* what) {
    if (!given)
      refuse(std::string("platoon.") + which, "none", what,
             "control needs reference, gs and gv; leave out all three to observe only");
  };
  require(!p.reference.empty(), "reference", "position (m) and velocity (m/s) of the reference");
  require(!std::isnan(p.gs), "gs", "the controller's gain on positions, 1/s^2");
  require(!std::isnan(p.gv), "gv", "the controller's gain on velocities, 1/s");
  return formation("platoon", p.reference, p.spacing, p.gs, p.gv, s.period, s.vehicles);
}

}  // namespace

Setting setting_of(const Platoon::Params& p, const Model& model, const Network& network) {
  Setting s;
  s.period = period_of(model);
  s.range = range_of(network);
  s.vehicles = network.agents();
  s.attacked = p.attacked;
  set_input(p, model, s);
  set_noise(p, s);
  s.q = p.initial_error;
  s.varpi = p.varpi;
  s.adaptive = p.adaptive;
  s.beta = std::isnan(p.threshold) ? 1.0 : p.threshold;
  require(s);
  if (std::isnan(p.threshold)) s.beta = best_threshold(s);
  return s;
}

}  // namespace platoon::detail

using platoon::BoundKind;

Platoon::Gains Platoon::design(const Params& p, const Model& model, const Network& network) {
  Gains g;
  g.setting = platoon::detail::setting_of(p, model, network);
  const int N = g.setting.vehicles;
  g.formation = platoon::detail::formation_of(p, g.setting);
  g.options.detector = p.detector;
  g.options.bound = p.bound == "safe"    ? BoundKind::safe
                    : p.bound == "tight" ? BoundKind::tight
                                         : BoundKind::printed;
  g.options.tie_by_bound = p.tie == "bound";
  g.options.cover = p.count == "cover";
  g.options.pairs = p.pairs;
  g.options.neighbours = p.neighbours;
  g.options.median = p.median;
  g.options.accuse_missing = p.accuse_missing;
  g.priors = platoon::detail::priors_of(p, N);
  // b attackers make at most 3 b suspects; four times that, and everything in a short string.
  g.room = std::min({N, 64 + 8 * p.attacked, LabelSet::kMost});
  std::vector<int> told;
  for (const auto& prior : g.priors) {
    for (const auto* set : {&prior.attacked, &prior.suspected})
      if (static_cast<int>(set->size()) > g.room)
        refuse("platoon.prior_suspected", amount(set->size(), "sensor"), "at most " + std::to_string(g.room));
    told.insert(told.end(), prior.free.begin(), prior.free.end());
  }
  std::sort(told.begin(), told.end());
  told.erase(std::unique(told.begin(), told.end()), told.end());
  // A free set is what was told, what windows near an attack cleared, or all but the accused and suspects.
  const int near = 4 * g.setting.range * p.attacked;
  g.room_free = std::max(2 * g.room, std::min(N, near) + static_cast<int>(told.size()));
  return g;
}

namespace platoon {

void check_inputs(const char* owner, const Model& model, std::span<const double> measurements) {
  if (!detail::records_inputs(model))
    refuse(
        "replay", "recorded vehicles without their inputs",
        "a model with inputs (platoon.model(vehicles, period, inputs=True)), one column of them per vehicle",
        std::string(owner) +
            " would take its own commands for theirs; a platoon filter without reference, gs and "
            "gv, with input_bound, observes vehicles of which no inputs are known");
  const auto M = static_cast<std::size_t>(model.total_outputs());
  for (int i = 0; i < model.agents(); ++i) {
    const auto at = static_cast<std::size_t>(model.offset(i) + model.outputs(i) - 1);
    const std::size_t rows = measurements.size() / M;
    std::size_t known = 0;
    for (std::size_t r = 0; r < rows; ++r) known += std::isnan(measurements[r * M + at]) ? 0 : 1;
    if (known != 0 && known + 1 < rows)  // what is applied after the last sample nobody needs
      refuse("replay", std::to_string(rows - known) + " missing inputs of vehicle " + std::to_string(i),
             "all of them, or none where the vehicles did what the filter commands",
             "a platoon filter without reference, gs and gv, with input_bound, does without");
  }
}

}  // namespace platoon

void Platoon::check_log(const Gains& g, const Model& model, std::span<const double> measurements) {
  if (g.formation.steers()) platoon::check_inputs("platoon", model, measurements);
}

std::vector<std::string> Platoon::refuted_words(unsigned bits) {
  using namespace platoon;
  const std::pair<unsigned, const char*> found[] = {
      {kTooMany, "more sensors were proved attacked than `attacked` allows"},
      {kTooManyRuns, "more suspects than that many attacked sensors can cause"},
      {kBothSets, "a sensor was proved both attacked and free of attack"},
      {kFreeImpossible, "a sensor known to be free of attack showed what no honest one can"},
      {kNoRoom, "more suspects than that many attacked sensors can cause"},
      {kNoCover, "contradictions between sensors that this many attacked ones cannot explain"},
      {kQuorum, "a median that attackers cannot move was further from the prediction than all bounds allow"}};
  std::string what;
  for (const auto& [bit, words] : found)
    if ((bits & bit) != 0 && what.find(words) == std::string::npos)
      what += (what.empty() ? "" : "; ") + std::string(words);
  if (what.empty()) what = "vehicles heard so from others";
  return {
      "The data contradict the assumptions: " + what +
      ". At least one of these is false: measurement_noise (or the bounds on its entries) and "
      "process_noise (with input_bound, if any) bound the noise; initial_error bounds the start; at most "
      "`attacked` sensors are attacked; relative sensors and messages are honest; or bound = \"printed\", "
      "which is no bound, was asked for. Vehicles that know of it report no bound, and no verdict as proof."};
}

std::unique_ptr<World> Platoon::world(const Gains& g, const WorldOptions& options) {
  if (!g.formation.steers())
    refuse("platoon.reference, gs, gv", "none of them",
           "all three, because simulated vehicles do what the filter commands",
           "a filter that only observes is for replays of recorded vehicles");
  return platoon::make_world(g.setting, g.formation, options);
}

}  // namespace garrison
