// SPDX-License-Identifier: Apache-2.0
// What is reported of one vehicle.
#include <algorithm>
#include <cmath>

#include "garrison/filters/platoon/filter.hpp"

namespace garrison {

using platoon::BoundKind;

Report Platoon::report_of(const Local&, const Gains& g, const platoon::VehicleState& s) noexcept {
  Report r;
  // Nothing is proved where an assumption is false.
  r.verdict = s.trouble == 0 || s.verdict == Verdict::silent ? s.verdict
              : s.verdict == Verdict::attacked               ? Verdict::suspected
                                                             : Verdict::not_tested;
  r.statistic = s.innovation;
  r.threshold = s.level;
  if (g.options.bound != BoundKind::printed && s.trouble == 0) r.bound = s.alpha.norm;
  return r;
}

void Platoon::expected_of(const Local& l, const Gains& g, const platoon::VehicleState& s,
                          double* out) noexcept {
  std::fill_n(out, l.outputs, kNaN);
  const double T = g.setting.period;
  const bool started = s.t >= 0;
  out[0] = started ? s.x[0] + T * s.x[1] : s.x[0];
  const double u = std::isnan(s.applied) ? s.u : s.applied;
  out[1] = started && !std::isnan(u) ? s.x[1] + T * u : s.x[1];
}

void Platoon::detail_of(const Local& l, const Gains& g, const platoon::VehicleState& s, std::size_t which,
                        std::vector<double>& out) {
  if (which == 3) {
    if (s.gains != nullptr && s.t > 0) out.assign(s.gains.get(), s.gains.get() + 2 * g.setting.range + 1);
    return;
  }
  const LabelSet& set = which == 0 ? s.sets.attacked : which == 1 ? s.sets.suspected : s.sets.free;
  const bool pairs = which == 1 && g.options.cover;
  for (int id = 0; id < l.agents; ++id)
    if (set.contains(id) || (pairs && id > 0 && set.contains(id - 1))) out.push_back(id);
}

}  // namespace garrison
