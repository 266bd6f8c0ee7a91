// SPDX-License-Identifier: Apache-2.0
// The tests of the structural filter, and what is remembered of them. Included by filter.hpp.
#pragma once

#include "garrison/filters/structural/filter.hpp"
#include "garrison/kernel/counting.hpp"

namespace garrison {

inline bool Structural::examine(const Gains& g, Memory& s, std::size_t id, double value, double std,
                                bool exact) noexcept {
  s.threshold = kNaN;
  s.statistic = std::abs(value);
  s.coarse = false;
  bool window = false;
  if (g.window > 1) {
    remember(g, s, exact ? value : kNaN);  // nothing of the start, whose error nobody knows
    window = exact && !s.broken;
    if (window) s.statistic = window_statistic(g, s, id);
  }
  if (s.start > 0 || std::isnan(s.statistic)) return false;
  if (window) {
    if (!std::isnan(g.std[id])) s.threshold = g.level;
  } else if (exact || (carries(g) && structural::varies(std, g.noise[id], g.innovation_std[id]))) {
    const double own = g.innovation ? g.innovation_std[id] : g.std[id];
    // A residual that vanishes when nothing is missing is no measure of what a gap does to it.
    const bool vanishes = carries(g) && !structural::varies(own, g.noise[id], g.innovation_std[id]);
    const double usual = vanishes ? g.innovation_std[id] : own;
    // What a sensor left out may be up to is in `std`: it must be able to come back.
    s.coarse = !(std <= kBlind * usual || (g.isolate && s.alarm));
    s.threshold = g.sample_level * std;
  }
  return s.statistic >= s.threshold;
}

inline void Structural::judge(const Local& l, const Gains& g, Memory& s, bool over) noexcept {
  const bool absent = g.accuse_missing && l.outputs > 0 && std::isnan(s.y);
  if (!absent && std::isnan(s.threshold)) {
    const bool could_be = !std::isnan(s.y) && s.start == 0;
    s.untold = could_be ? one_more(s.untold) : s.untold;
    if (s.untold < std::max(kForgotten, g.clear_after)) return;
    s.alarm = false;
    s.accused.clear();
    return;
  }
  s.untold = 0;
  over = over || absent;
  if (s.coarse && !over) return;
  s.above = over ? one_more(s.above) : 0;
  s.below = over ? 0 : one_more(s.below);
  if (s.above >= g.alarm_after) s.alarm = true;
  if (s.below >= g.clear_after) s.alarm = false;
  s.accused.clear();
  if (s.alarm) s.accused.insert(l.id);
}

inline void Structural::remember(const Gains& g, Memory& s, double residual) noexcept {
  if (std::isnan(residual)) {
    s.broken = s.broken || s.start == 0;
    s.filled = s.oldest = 0;
    return;
  }
  s.last[static_cast<std::size_t>((s.oldest + s.filled) % g.window)] = residual;
  if (s.filled < g.window)
    ++s.filled;
  else
    s.oldest = (s.oldest + 1) % g.window;
  s.broken = s.broken && s.filled < g.window;
}

inline double Structural::window_statistic(const Gains& g, const Memory& s, std::size_t id) noexcept {
  const auto w = static_cast<std::size_t>(g.window);
  if (s.filled < g.window || g.precision.empty()) return kNaN;
  const double* S = g.precision.data() + id * w * w;
  double sum = 0.0;
  for (std::size_t a = 0; a < w; ++a) {
    double row = 0.0;
    for (std::size_t b = 0; b < w; ++b)
      row += S[a * w + b] * s.last[(static_cast<std::size_t>(s.oldest) + b) % w];
    sum += row * s.last[(static_cast<std::size_t>(s.oldest) + a) % w];
  }
  return sum;
}

}  // namespace garrison
