// SPDX-License-Identifier: Apache-2.0
// One sample of one vehicle: predict and send, then detect, observe and steer with what arrived.
#include "garrison/filters/platoon/vehicle.hpp"

#include <cmath>

#include "garrison/filters/platoon/bounds.hpp"
#include "garrison/filters/platoon/view.hpp"
#include "garrison/filters/platoon/world.hpp"

namespace garrison::platoon {
namespace {

bool usable(const double* y) noexcept { return std::abs(y[0]) < kHuge && std::abs(y[1]) < kHuge; }

double size(const Vec<2>& x) noexcept { return std::abs(x[0]) + std::abs(x[1]); }

/// (15) and what is known of its error. An input that nobody tells is taken for zero, within its bound.
void predict(const Setting& g, VehicleState& s) noexcept {
  double u = std::isnan(s.applied) ? s.u : s.applied;
  if (std::isnan(u)) {
    u = 0.0;
    if (std::isnan(g.input)) s.alpha = {};
  }
  s.prediction[0] = s.x[0] + g.period * s.x[1];
  s.prediction[1] = s.x[1] + g.period * u;
  s.foreseen =
      predicted(g, s.alpha) + rounding(size(s.prediction) + g.period * std::abs(s.x[1]) + std::abs(s.x[1]));
}

void tell(LabelSet& set, const std::vector<int>& ids) {
  for (const int id : ids) set.insert(id);
}

}  // namespace

void start(const Local& l, const Shared& shared, const Vec<2>& x0, VehicleState& s, VehicleMessage& m) {
  VehicleState fresh;
  fresh.x = fresh.prediction = x0;
  const double q = shared.setting.q + rounding(size(x0));
  fresh.alpha = fresh.foreseen = {q, q, q};
  if (!shared.formation.steers()) fresh.u = kNaN;
  fresh.sets.attacked = LabelSet(shared.room);
  fresh.sets.suspected = LabelSet(shared.room);
  fresh.sets.free = LabelSet(shared.room_free);
  if (!shared.priors.empty()) {
    const Prior& prior = shared.priors[static_cast<std::size_t>(l.id)];
    tell(fresh.sets.attacked, prior.attacked);
    // A lone suspect is no pair, and the exact count needs none that is not proved.
    if (!shared.options.cover) tell(fresh.sets.suspected, prior.suspected);
    tell(fresh.sets.free, prior.free);
  }
  if (in_V1(l.id, l.agents, shared.setting.range))
    fresh.gains = std::make_unique<double[]>(static_cast<std::size_t>(2 * shared.setting.range + 1));
  fresh.window = 2 * shared.setting.range + 1;
  if (shared.options.pairs) fresh.suspicions = std::make_unique<Suspicions>(2 * shared.setting.range + 1);
  m = VehicleMessage{};
  m.sets = fresh.sets;
  s = std::move(fresh);
}

void sense(const Local& l, const Shared& shared, VehicleState& s, const double* y, std::int64_t t,
           VehicleMessage& m) noexcept {
  const Outputs outputs = Outputs::of(l.id, l.outputs);
  if (t > 0) predict(shared.setting, s);
  s.t = t;
  s.has_y = usable(y);
  const bool missing = std::isnan(y[0]) || std::isnan(y[1]);
  s.impossible = !s.has_y && (!missing || shared.options.accuse_missing);
  s.has_link = outputs.relative && usable(y + 2);
  for (int k = 0; k < 2; ++k) {
    s.y[k] = s.has_y ? y[k] : 0.0;
    s.link[k] = s.has_link ? y[2 + k] : 0.0;
  }
  s.applied = outputs.input && std::abs(y[outputs.at_input()]) < kHuge ? y[outputs.at_input()] : kNaN;
  m.has_y = s.has_y;
  m.has_link = s.has_link;
  for (int k = 0; k < 2; ++k) {
    m.numbers[k] = s.y[k];
    m.numbers[2 + k] = s.link[k];
    m.numbers[4 + k] = s.prediction[k];
  }
  m.bound = s.foreseen.norm;
  m.doubt = s.trouble != 0;
  m.sets = s.sets;
}

void fuse(const Local& l, const Shared& shared, VehicleState& s,
          const Inbox<VehicleMessage>& inbox) noexcept {
  const View view(l.id, l.agents, shared.setting.range, s, inbox);
  if (s.t > 0) {
    if (shared.options.detector) {
      for (std::size_t k = 0; k < inbox.size(); ++k) {
        const Sets& told = inbox[k].sets;
        if (inbox[k].doubt) s.trouble |= kHeard;
        const bool same = s.sets.attacked == told.attacked && s.sets.suspected == told.suspected &&
                          s.sets.free == told.free;
        if (same) continue;
        s.changed = true;
        if (!s.sets.attacked.unite(told.attacked) || !s.sets.suspected.unite(told.suspected) ||
            !s.sets.free.unite(told.free))
          s.trouble |= kNoRoom;
      }
      detect(l, shared, view, s);
    }
    observe(l, shared, view, s);
  }
  control(l, shared, view, s);
}

void rejoin(const Local& l, const Shared& shared, VehicleState& s, const Inbox<VehicleMessage>& inbox,
            std::int64_t t) noexcept {
  if (!(std::abs(s.x[0]) < kHuge) || !(std::abs(s.x[1]) < kHuge)) s.x.setZero();
  s.prediction = s.x;
  s.alpha = s.foreseen = {};
  if (s.t != t) s.has_y = s.has_link = false;  // it only listened: what it measured last is of another sample
  s.t = t;
  const View view(l.id, l.agents, shared.setting.range, s, inbox);
  observe(l, shared, view, s);
  control(l, shared, view, s);
}

}  // namespace garrison::platoon
