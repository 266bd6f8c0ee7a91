// SPDX-License-Identifier: Apache-2.0
// One sample of one vehicle under the controllers that the paper compares with.
#include <algorithm>
#include <cmath>

#include "garrison/filters/platoon/baseline.hpp"
#include "garrison/filters/platoon/view.hpp"

namespace garrison {

using namespace platoon;

void PlatoonBaseline::sense_one(const Local& l, const Gains& g, Driver& s, const double* y, std::int64_t t,
                                VehicleMessage& m) noexcept {
  const double last[2] = {s.y[0], s.y[1]};
  platoon::sense(l, g.shared, s, y, t, m);
  if (s.has_y || g.kind == Kind::pbe) return;
  for (int k = 0; k < 2; ++k) s.y[k] = m.numbers[k] = last[k];
  m.has_y = true;
}

namespace {

/// pbe: the mean of what all in range say of this vehicle, entry by entry and without the extremes.
void trimmed_mean(const Setting& g, const View& view, VehicleState& s) noexcept {
  const auto updated = [&](const double* y, const double* prediction, bool has_y, int k) {
    return has_y ? prediction[k] + (y[k] - prediction[k]) / g.varpi : prediction[k];
  };
  double column[2 * kMostRange + 1];
  for (int k = 0; k < 2; ++k) {
    int count = 0;
    for (int p = 0; p < view.size(); ++p) {
      const VehicleMessage* m = view[p].message;
      if (p == g.range)
        column[count++] = updated(s.y, s.prediction.data(), s.has_y, k);
      else if (m != nullptr && view[p].linked)
        column[count++] = updated(m->y(), m->prediction(), m->has_y, k) + view[p].link[k];
    }
    std::sort(column, column + count);
    const int trim = std::min(g.attacked, (count - 1) / 2);
    double sum = 0.0;
    for (int j = trim; j < count - trim; ++j) sum += column[j];
    s.x[k] = sum / (count - 2 * trim);
  }
}

}  // namespace

void PlatoonBaseline::fuse_one(const Local& l, const Gains& g, Driver& s,
                               const Inbox<VehicleMessage>& inbox) noexcept {
  const Setting& setting = g.shared.setting;
  const Formation& f = g.shared.formation;
  const View view(l.id, l.agents, setting.range, s, inbox);
  if (g.kind == Kind::pbe) {
    if (s.t > 0) trimmed_mean(setting, view, s);
  } else {
    s.x = Vec<2>(s.y[0], s.y[1]);
  }
  const Motion own{s.x[0], s.x[1]};
  s.u = l.id == 0 ? f.pull(own, f.reference_at(s.t), 0) : 0.0;
  for (const int side : {-1, 1}) {
    const int j = l.id + side;
    const int slot = side < 0 ? 0 : 1;
    const VehicleMessage* other = view[setting.range + side].message;
    if (j < 0 || j >= l.agents) continue;
    Motion seen{kNaN, kNaN};
    if (g.kind == Kind::pbe) {
      if (other != nullptr) seen = {other->prediction()[0], other->prediction()[1]};
    } else if (g.kind == Kind::pwm || (s.t == 0 && other != nullptr)) {
      if (other != nullptr) seen = {other->y()[0], other->y()[1]};
    } else if (s.known[slot]) {  // y_jj(t-1), moved on by x_j^*(t) - x_j^*(t-1)
      const Motion before = f.desired(j, s.t - 1);
      const Motion now = f.desired(j, s.t);
      seen = {s.heard[slot][0] - before.s + now.s, s.heard[slot][1] - before.v + now.v};
    }
    if (!std::isnan(seen.s)) s.u += f.pull(own, seen, side);
    s.known[slot] = other != nullptr;
    if (other != nullptr) std::copy_n(other->y(), 2, s.heard[slot]);
  }
}

}  // namespace garrison
