// SPDX-License-Identifier: Apache-2.0
// Algorithm 1: (12)-(14) and the bounds that belong to it.
#include <algorithm>
#include <cmath>

#include "garrison/filters/platoon/bounds.hpp"
#include "garrison/filters/platoon/view.hpp"
#include "quorum.hpp"

namespace garrison::platoon {
namespace {

/// What less than half can move is further from the prediction than both bounds allow: one of them is false.
void compare(const Setting& g, const Sightings& heard, VehicleState& s) noexcept {
  const Bound level = s.foreseen + median_error(g);
  if (heard.mostly_near(s.prediction, level)) return;
  const Vec<2> middle = heard.middle();
  const double size = length(middle.data()) + length(s.prediction.data());
  if (exceeds(std::abs(middle[0] - s.prediction[0]), level.position, size) ||
      exceeds(std::abs(middle[1] - s.prediction[1]), level.velocity, size))
    s.trouble |= kQuorum;
}

/// (12) with the prediction of the best source (13), a vehicle of V_1 or with a free sensor; false: nobody is
/// within reach. `varpi` = 1: the own prediction is worth nothing.
bool borrow(const Local& l, const Shared& shared, const View& view, double varpi, VehicleState& s) noexcept {
  const Setting& g = shared.setting;
  BestSource best(shared.options.tie_by_bound);
  for (int p = 0; p < view.size(); ++p) {
    if (p == g.range || !view[p].linked || view[p].message == nullptr || !view[p].message->covered())
      continue;
    const int j = view.id_of(p);
    if (in_V1(j, l.agents, g.range) || s.sets.free.contains(j))
      best.offer(j, std::abs(p - g.range), view[p].message->bound);
  }
  s.source = best.id();
  if (s.source < 0) return false;
  const Seen& j = view[s.source - l.id + g.range];
  for (int k = 0; k < 2; ++k)
    s.x[k] = s.prediction[k] + (j.message->prediction()[k] + j.link[k] - s.prediction[k]) / varpi;
  const double bound = j.message->bound;
  s.alpha =
      moved(s.foreseen, varpi, Bound{bound, bound, bound} + relative_noise(g) * std::abs(s.source - l.id));
  return true;
}

/// V_1 behind a gap: nothing of the past counts. Where too many of those heard may lie a neighbour's
/// prediction serves as for vehicles outside V_1, then what they leave possible; else there is no bound.
void start_anew(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept {
  s.beta = kNaN;
  s.source = -1;
  s.x = s.prediction;
  std::fill_n(s.gains.get(), view.size(), 0.0);
  s.verdict = Verdict::not_tested;
  const Sightings heard(shared, view, s);
  if (!heard.certain() && (borrow(l, shared, view, 1.0, s) || take_agreed(shared, view, s))) return;
  s.x = heard.middle();
  if (heard.certain()) s.alpha = median_error(shared.setting);
}

/// Saturated innovations of everybody in range.
struct Innovations {
  Window window;
  double noise[2 * kMostRange + 1];  // of the undecided, in falling order
  double free_noise = 0.0;           // of the free ones, summed
  double step[2] = {0.0, 0.0};       // sum of k eta
};
Innovations innovations(const Setting& g, const View& view, VehicleState& s) noexcept {
  Innovations all;
  Window& w = all.window;
  w.proved = s.sets.attacked.count();
  // Far ones first: the noise levels of the undecided then come in falling order.
  for (int distance = g.range; distance >= 0; --distance) {
    for (int side = distance == 0 ? 1 : -1; side <= 1; side += 2) {
      const int p = g.range + side * distance;
      const int id = view.id_of(p);
      double& k = s.gains[static_cast<std::size_t>(p)];
      k = 0.0;
      const bool attacked = s.sets.attacked.contains(id);
      const bool free = s.sets.free.contains(id);
      w.free_in_reach += free ? 1 : 0;
      if (attacked || !view[p].measured) continue;
      const double eta[2] = {view[p].y[0] - s.prediction[0], view[p].y[1] - s.prediction[1]};
      const double norm = length(eta);
      if (!(norm < kHuge)) continue;  // a lie in a message: as good as nothing
      k = gain(s.beta, norm, attacked, free);
      all.step[0] += k * eta[0];
      all.step[1] += k * eta[1];
      const double noise = reached_noise(g, distance).norm;
      if (free) {
        ++w.free;
        all.free_noise += noise;
      } else {
        all.noise[w.undecided++] = noise;
      }
    }
  }
  return all;
}

/// The bound that belongs to (12) with these innovations.
Bound bound_of(const Shared& shared, const Innovations& all, const VehicleState& s) noexcept {
  const Setting& g = shared.setting;
  if (shared.options.bound == BoundKind::printed)
    return {printed_bound(g, s.beta, s.alpha.norm, all.window), kInfinity, kInfinity};
  Bound bound = SafeStep(g, s.beta, s.foreseen.norm, all.window)(s.foreseen, reached_noise(g, g.range));
  if (shared.options.bound == BoundKind::tight)
    bound.norm = tight_bound(g, s.beta, s.foreseen.norm, all.window, all.free_noise, all.noise);
  return bound.sharpened();
}

/// V_1.
void update_inner(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept {
  const Setting& g = shared.setting;
  if (!s.foreseen.known()) return start_anew(l, shared, view, s);
  const bool printed = shared.options.bound == BoundKind::printed;
  s.beta = threshold(g, s.foreseen.norm);
  s.source = -1;
  const Innovations all = innovations(g, view, s);
  const Bound bound = bound_of(shared, all, s);
  // Where many were lost those who may lie can outweigh the rest: the prediction alone is better then, and
  // without this the bound and the liars' pull, which follows it, would feed each other.
  const bool used = printed || bound.norm <= s.foreseen.norm;
  s.x = s.prediction;
  if (used)
    for (int k = 0; k < 2; ++k) s.x[k] += all.step[k] / (2.0 * g.range);
  else
    std::fill_n(s.gains.get(), view.size(), 0.0);
  s.alpha = used ? bound : s.foreseen;
  const Sightings heard(shared, view, s);
  if (heard.certain() && !printed) compare(g, heard, s);
  if (heard.certain() && shared.options.median && median_bound(g) < s.alpha.norm) {
    s.x = heard.middle();
    s.alpha = median_error(g);
  }
  const bool own = s.gains[static_cast<std::size_t>(g.range)] >= 1.0 && !s.sets.suspected.contains(l.id);
  s.verdict = own ? Verdict::cleared : used ? Verdict::suspected : Verdict::not_tested;
}

/// The others: their own measurement once it is known to be free, else a neighbour's prediction.
void update_outer(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept {
  const Setting& g = shared.setting;
  s.source = -1;
  s.beta = kNaN;
  // Behind a gap the prediction is worth nothing: gain 1 in place of 1/varpi.
  const double varpi = s.foreseen.known() ? g.varpi : 1.0;
  if (s.sets.free.contains(l.id) && s.has_y) {
    for (int k = 0; k < 2; ++k) s.x[k] = s.prediction[k] + (s.y[k] - s.prediction[k]) / varpi;
    s.alpha = moved(s.foreseen, varpi, absolute_noise(g));
    return;
  }
  s.x = s.prediction;
  s.alpha = s.foreseen;
  borrow(l, shared, view, varpi, s);  // nobody within reach: the prediction stands
}

/// Size of what was added up for the estimate: it can be near zero where its terms are not.
double size_of_sums(const View& view, const VehicleState& s) noexcept {
  double links = 0.0;
  for (int p = 0; p < view.size(); ++p)
    if (view[p].linked) links = std::max(links, length(view[p].link));
  return length(s.x.data()) + length(s.prediction.data()) + links + (std::isnan(s.beta) ? 0.0 : s.beta);
}

}  // namespace

void observe(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept {
  if (in_V1(l.id, l.agents, shared.setting.range)) {
    update_inner(l, shared, view, s);
  } else {
    update_outer(l, shared, view, s);
    s.verdict = s.sets.free.contains(l.id) ? Verdict::cleared : Verdict::suspected;
  }
  if (!s.has_y) s.verdict = Verdict::silent;
  if (s.sets.attacked.contains(l.id)) s.verdict = Verdict::attacked;
  s.alpha = s.alpha + rounding(size_of_sums(view, s));
  if (!(s.alpha.norm < kHuge)) s.alpha = {};  // a bound that has grown this far says nothing
}

}  // namespace garrison::platoon
