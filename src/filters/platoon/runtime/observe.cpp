// SPDX-License-Identifier: Apache-2.0
// Algorithm 1: (12)-(14) and the bounds that belong to it.
#include <algorithm>
#include <cmath>

#include "garrison/filters/platoon/bounds.hpp"
#include "garrison/filters/platoon/view.hpp"

namespace garrison::platoon {
namespace {

/// Middle of `count` values (the mean of the two middle ones); reorders them.
double median(double* values, int count) noexcept {
  std::sort(values, values + count);
  return count % 2 == 1 ? values[count / 2] : (values[count / 2 - 1] + values[count / 2]) / 2.0;
}

/// S3: the componentwise median of what sensors not yet proved attacked say, while less than half can lie.
bool take_median(const Shared& shared, const View& view, VehicleState& s) noexcept {
  double column[2][2 * kMostRange + 1];
  int count = 0;
  for (int p = 0; p < view.size(); ++p) {
    if (!view[p].measured || s.sets.attacked.contains(view.id_of(p))) continue;
    for (int k = 0; k < 2; ++k) column[k][count] = view[p].y[k];
    ++count;
  }
  if (2 * (shared.setting.attacked - s.sets.attacked.count()) >= count || count == 0) return false;
  for (int k = 0; k < 2; ++k) s.x[k] = median(column[k], count);
  s.alpha = median_bound(shared.setting);
  return true;
}

/// V_1 behind a gap: nothing of the past counts. Where too little is heard the estimate is the mean of what
/// is, and stays without a bound.
void start_anew(const Shared& shared, const View& view, VehicleState& s) noexcept {
  s.beta = kNaN;
  s.source = -1;
  s.x = s.prediction;
  std::fill_n(s.gains.get(), view.size(), 0.0);
  s.verdict = Verdict::not_tested;
  if (take_median(shared, view, s)) return;
  Vec<2> sum = Vec<2>::Zero();
  int count = 0;
  for (int p = 0; p < view.size(); ++p) {
    if (!view[p].measured || s.sets.attacked.contains(view.id_of(p))) continue;
    for (int k = 0; k < 2; ++k) sum[k] += view[p].y[k];
    ++count;
  }
  if (count > 0) s.x = sum / count;
}

/// V_1: saturated innovations of everybody in range.
void update_inner(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept {
  const Setting& g = shared.setting;
  const double before = s.alpha;
  if (std::isnan(before)) return start_anew(shared, view, s);
  s.beta = threshold(g, before);
  s.source = -1;
  Window w;
  w.proved = s.sets.attacked.count();
  double noise[2 * kMostRange + 1];
  double free_noise = 0.0;
  double step[2] = {0.0, 0.0};
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
      const double norm = std::hypot(eta[0], eta[1]);
      if (!(norm < kHuge)) continue;  // a lie in a message: as good as nothing
      k = gain(s.beta, norm, attacked, free);
      step[0] += k * eta[0];
      step[1] += k * eta[1];
      if (free) {
        ++w.free;
        free_noise += (distance + 1) * g.mu;
      } else {
        noise[w.undecided++] = (distance + 1) * g.mu;
      }
    }
  }
  for (int k = 0; k < 2; ++k) s.x[k] = s.prediction[k] + step[k] / (2.0 * g.range);
  switch (shared.options.bound) {
    case BoundKind::safe:
      s.alpha = safe_bound(g, s.beta, before, w);
      break;
    case BoundKind::tight:
      s.alpha = tight_bound(g, s.beta, before, w, free_noise, noise);
      break;
    case BoundKind::printed:
      s.alpha = printed_bound(g, s.beta, before, w);
      break;
  }
  if (shared.options.median && median_bound(g) < s.alpha) take_median(shared, view, s);
  const bool own = s.gains[static_cast<std::size_t>(g.range)] >= 1.0 && !s.sets.suspected.contains(l.id);
  s.verdict = own ? Verdict::cleared : Verdict::suspected;
}

/// The others: their own measurement once it is known to be free, else a neighbour's prediction.
void update_outer(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept {
  const Setting& g = shared.setting;
  s.source = -1;
  s.beta = kNaN;
  const bool free = s.sets.free.contains(l.id);
  // Behind a gap the prediction is worth nothing: gain 1 in place of 1/varpi.
  const bool gap = std::isnan(s.alpha);
  const double varpi = gap ? 1.0 : g.varpi;
  if (free && s.has_y) {
    for (int k = 0; k < 2; ++k) s.x[k] = s.prediction[k] + (s.y[k] - s.prediction[k]) / varpi;
    s.alpha = gap ? g.mu : free_bound(g, s.alpha);
    return;
  }
  BestSource best(shared.options.tie_by_bound);
  for (int p = 0; p < view.size(); ++p) {
    if (p == g.range || !view[p].linked || view[p].message == nullptr || !view[p].message->covered())
      continue;
    const int j = view.id_of(p);
    if (in_V1(j, l.agents, g.range) || s.sets.free.contains(j))
      best.offer(j, std::abs(p - g.range), view[p].message->alpha);
  }
  s.source = best.id();
  if (s.source < 0) {  // nobody within reach: the prediction stands
    s.x = s.prediction;
    s.alpha = predicted_bound(g, s.alpha);
    return;
  }
  const Seen& j = view[s.source - l.id + g.range];
  for (int k = 0; k < 2; ++k)
    s.x[k] = s.prediction[k] + (j.message->prediction()[k] + j.link[k] - s.prediction[k]) / varpi;
  const int distance = std::abs(s.source - l.id);
  s.alpha = gap ? anew_bound(g, j.message->alpha, distance)
                : borrowed_bound(g, s.alpha, j.message->alpha, distance);
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
  if (!(s.alpha < kHuge)) s.alpha = kNaN;  // a bound that has grown this far says nothing
}

}  // namespace garrison::platoon
