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
  if (pairs.size() % 2 != 0)
    refuse(owner, std::to_string(pairs.size()) + " numbers", "pairs vehicle, sensor");
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
               "sensor " + std::to_string(id) + " (told to vehicle " + std::to_string(i) + ")",
               "attacked and free sets that do not intersect",
               "it is in a prior attacked set too: remove it from one of both");
  if (count > p.attacked)
    refuse("platoon.prior_attacked", std::to_string(count) + " sensors",
           "at most b = attacked = " + std::to_string(p.attacked), "raise attacked");
  return priors;
}

}  // namespace

Setting setting_of(const Platoon::Params& p, const Model& model, const Network& network) {
  Setting s;
  s.period = period_of(model);
  s.range = range_of(network);
  s.vehicles = network.agents();
  s.attacked = p.attacked;
  s.eps = p.process_noise;
  s.mu = p.measurement_noise;
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
  g.formation = platoon::formation("platoon", p.reference, p.spacing, p.gs, p.gv, g.setting.period, N);
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
        refuse("platoon.prior_suspected", std::to_string(set->size()) + " sensors",
               "at most " + std::to_string(g.room));
    told.insert(told.end(), prior.free.begin(), prior.free.end());
  }
  std::sort(told.begin(), told.end());
  told.erase(std::unique(told.begin(), told.end()), told.end());
  // A free set is what was told, what windows near an attack cleared, or all but the accused and suspects.
  const int near = 4 * g.setting.range * p.attacked;
  g.room_free = std::max(2 * g.room, std::min(N, near) + static_cast<int>(told.size()));
  return g;
}

std::unique_ptr<World> Platoon::world(const Gains& g, const WorldOptions& options) {
  return platoon::make_world(g.setting, g.formation, options);
}

}  // namespace garrison
