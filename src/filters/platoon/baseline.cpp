// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/platoon/baseline.hpp"

#include "garrison/filters/platoon/loop.hpp"
#include "garrison/filters/platoon/partition.hpp"
#include "garrison/filters/platoon/world.hpp"

namespace garrison {

using namespace platoon;

PlatoonBaseline::Gains PlatoonBaseline::design(const Params& p, const Model& model, const Network& network) {
  Gains g;
  g.kind = p.kind == "pwm" ? Kind::pwm : p.kind == "pbe" ? Kind::pbe : Kind::ptd;
  Setting& s = g.shared.setting;
  s.period = period_of(model);
  s.range = range_of(network);
  if (s.range > kMostRange)
    refuse("range (L)", std::to_string(s.range), "at most " + std::to_string(kMostRange));
  s.vehicles = network.agents();
  s.attacked = p.attacked;
  s.varpi = p.varpi;
  s.eps = p.process_noise;
  s.mu = p.measurement_noise;
  s.q = kNaN;  // nothing rests on the start
  g.shared.formation =
      formation("platoon_baseline", p.reference, p.spacing, p.gs, p.gv, s.period, s.vehicles);
  return g;
}

Check PlatoonBaseline::check(const Params& p, const Model& model, const Network& network) {
  const Gains g = design(p, model, network);
  Check c;
  c.conditions.push_back({"Assumption 4", p.gv, "> T g_s, and T^2 g_s - 2 T g_v > -4/sigma_max",
                          assumption4(g.shared.setting.vehicles, g.shared.setting.period, p.gs, p.gv),
                          "the controlled string is stable"});
  return c;
}

std::unique_ptr<World> PlatoonBaseline::world(const Gains& g, const WorldOptions& options) {
  return make_world(g.shared.setting, g.shared.formation, options);
}

}  // namespace garrison
