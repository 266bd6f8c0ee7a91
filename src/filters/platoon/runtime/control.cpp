// SPDX-License-Identifier: Apache-2.0
// Algorithm 3, and what the vehicle can certify of its gap.
#include <algorithm>
#include <cmath>

#include "garrison/filters/platoon/bounds.hpp"
#include "garrison/filters/platoon/view.hpp"

namespace garrison::platoon {
namespace {

/// Gap to the vehicle ahead, s_{i-1} - s_i, and how far it can be from the truth.
struct Gap {
  double value;
  double error;
};

/// An estimate that can be off by more than twice what a start may be is nothing to steer by.
bool knows(const Setting& g, double bound) noexcept { return !std::isnan(bound) && !(bound > 2.0 * g.q); }

/// u_i of Algorithm 3. `ahead`, `behind`: messages of these vehicles, null where there is none.
double steer(const Local& l, const Setting& g, const Formation& f, const Motion& own,
             const VehicleMessage* ahead, const VehicleMessage* behind, const VehicleState& s) noexcept {
  double u = 0.0;
  if (l.id == 0)
    u += f.pull(own, f.reference_at(s.t), 0);
  else if (ahead != nullptr && knows(g, ahead->bound))
    u += f.pull(own, {ahead->prediction()[0], ahead->prediction()[1]}, -1);
  else if (s.has_link)  // nothing to be had from it: where our own secured sensor sees it
    u += f.pull(own, {own.s - s.link[0], own.v - s.link[1]}, -1);
  if (behind != nullptr && knows(g, behind->bound))
    u += f.pull(own, {behind->prediction()[0], behind->prediction()[1]}, 1);
  return u;
}

}  // namespace

/// A vehicle that does not know where it is follows the one ahead by its secured sensor, or keeps its speed.
void control(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept {
  const Formation& f = shared.formation;
  const Setting& g = shared.setting;
  const Motion own{s.x[0], s.x[1]};
  const VehicleMessage* ahead = l.id > 0 ? view[g.range - 1].message : nullptr;
  const VehicleMessage* behind = l.id + 1 < l.agents ? view[g.range + 1].message : nullptr;
  if (f.steers())
    s.u = knows(g, s.alpha.norm) ? steer(l, g, f, own, ahead, behind, s)
          : s.has_link           ? f.pull({s.link[0], s.link[1]}, {0.0, 0.0}, -1)
                                 : 0.0;
  s.gap[0] = s.gap[1] = kNaN;
  if (l.id == 0) return;
  const auto certify = [&](const Gap& gap) {
    const double error = gap.error + rounding(std::abs(own.s) + std::abs(gap.value));
    const double least = gap.value - error;
    const double off = std::abs(gap.value - f.spacing) + error;
    if (!(s.gap[0] >= least)) s.gap[0] = least;
    if (!(s.gap[1] <= off)) s.gap[1] = off;
  };
  if (s.has_link) certify({-s.link[0], relative_noise(g).position});
  if (ahead != nullptr && ahead->covered() && s.alpha.known() && s.trouble == 0 &&
      shared.options.bound != BoundKind::printed)
    certify({ahead->prediction()[0] - own.s, ahead->bound + s.alpha.position});
}

}  // namespace garrison::platoon
