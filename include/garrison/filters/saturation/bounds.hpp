// SPDX-License-Identifier: Apache-2.0
// The levels that a saturation filter limits and tests with, and the bounds that it reports, from what an
// agent remembers.
#pragma once

#include <algorithm>
#include <cmath>

#include "garrison/filters/saturation/adaptive.hpp"
#include "garrison/filters/saturation/detector.hpp"
#include "garrison/filters/saturation/parts.hpp"

namespace garrison::saturation {

/// Part of the numbers that rounding of many samples may change.
inline constexpr double kRounding = 1e-12;

inline bool bounds_errors(const Gains& g) noexcept { return g.bounded || !g.table.empty(); }

/// beta in force at t.
inline double beta_now(const Gains& g, const Memory& s) noexcept {
  return g.adaptive ? s.level : s.loss != nullptr ? s.loss->clip : g.beta;
}

/// Whether the data-free table holds for this estimate.
inline bool covered(const Gains& g, const Memory& s) noexcept {
  return !g.table.empty() && s.intact && !s.refuted;
}
/// Whether theorem L holds for it instead.
inline bool recovers(const Memory& s) noexcept { return s.loss != nullptr && !s.intact && !s.refuted; }

/// As many sensors are proved as can be attacked: the others need no test.
inline bool knows_all(const Gains& g, const Memory& s) noexcept {
  return g.detector && !s.refuted && s.d >= g.setting.attacked;
}
inline void look_for_refutation(const Gains& g, Memory& s) noexcept {
  if (g.detector) s.refuted = s.proved.size() > g.setting.attacked;
}
/// k_i of (4), the least of this agent's outputs; 0 when nothing was used.
inline double gain_now(const Gains& g, const Memory& s) noexcept {
  if (s.verdict == Verdict::attacked || s.verdict == Verdict::silent) return 0.0;
  const double h = std::abs(s.innovation);
  return s.verdict == Verdict::suspected && h > beta_now(g, s) ? beta_now(g, s) / h : 1.0;
}

/// h > phi (15) beyond rounding of numbers of this size: for n = 1 the bound (16) is attained, a bare ">"
/// accuses honest sensors.
inline bool exceeds(double h, double phi, double size) noexcept {
  return std::isinf(h) || h > phi + kRounding * (phi + size);
}

/// d of (14) for rho(t).
inline int counted(const Gains& g, const Memory& s) noexcept {
  return g.detector && g.sharp_index ? s.proved.size() : s.d;
}
/// rho(t) of (7), rhobar_i(t) of (14) or rho_t of the adaptive threshold, from the values at t-1.
inline double rho_now(const Gains& g, const Memory& s) noexcept {
  const int d = counted(g, s);
  if (!g.bounded || !s.started || d == s.still) return s.rho;
  if (g.adaptive) return adaptive_next(g.setting, g.varpi, s.rho, s.p).rho;
  if (!g.detector) return rho_bar_next(g.setting, g.q0, s.rho, g.p0, 0);  // (7): p0 instead of p(t-1)
  return rho_bar_next(g.setting, g.q0, s.rho, s.p, d);
}
/// p(t) of (10), or of the adaptive threshold.
inline double p_now(const Gains& g, const Memory& s) noexcept {
  if (!g.bounded || !s.started || s.still >= 0) return s.p;
  // The level that all agents share; an agent's own may be lower.
  const double beta = g.adaptive ? adaptive_threshold(g.setting, s.rho, s.p) : g.beta;
  return disagreement_next(g.setting, s.p, beta);
}

/// Moves rho and p to t-1 and sets the level in force at t; data-free without the detector.
inline void advance_bounds(const Gains& g, Memory& s) noexcept {
  const int d = counted(g, s);
  if (d != s.still) {
    const double rho = rho_now(g, s);
    const double p = p_now(g, s);
    // A recursion that has reached its limit, to the last bit, goes on with it: three divisions and a root
    // less.
    s.still = s.started && rho == s.rho && p == s.p ? d : -1;
    s.rho = rho;
    s.p = p;
  }
  s.started = true;
  if (g.adaptive) s.level = adaptive_threshold(g.setting, s.rho, s.p);
  if (!g.detector) return;
  s.d = s.proved.size();
  if (s.full < 0 && knows_all(g, s) && g.table.proved.sets() > 0) {
    s.full = s.t;  // the sample before this one
    s.which = g.table.proved.find(s.proved);
  }
  s.level = detection_threshold(g.setting, s.rho, s.p);
}

// Of an agent that a message was lost behind, with `recovery` (theorem L). What is rare must not slow down
// what is not.

/// On the error of the estimate of sample s.t.
GARRISON_COLD inline double recovered_bound(const Local& l, const Gains& g, const Memory& s) noexcept {
  return g.table.recovered(l.id, s.t, *s.loss);
}

/// Levels of sample s.t; whether the agent tests.
GARRISON_COLD inline bool take_levels(const Local& l, const Gains& g, Memory& s) noexcept {
  LossRecord& r = *s.loss;
  const auto [honest, clip] = g.table.levels_after(l.id, s.t, r, r.bound, g.beta);
  r.state = g.table.losses.excess.rebase(r.state, s.t - 1);
  r.lost = false;
  r.clip = clip;
  if (!(honest < kInfinity)) return false;
  s.level = honest;
  return g.detector && !s.refuted;
}

GARRISON_COLD inline double recovered_alarm_level(const Local& l, const Gains& g, const Memory& s) noexcept {
  const LossRecord& r = *s.loss;
  const double bound = g.table.recovered(l.id, s.t, r);
  const auto [honest, clip] = g.table.levels_after(l.id, s.t + 1, r, bound, g.beta);
  if (honest < kInfinity) return g.detector || g.adaptive ? honest : clip;
  return g.adaptive ? innovation_bound(g.setting, rho_now(g, s), p_now(g, s)) : g.beta;
}

GARRISON_COLD inline void start_anew(const Local& l, const Gains& g, Memory& s) noexcept {
  s.loss->state = certificate::Recovery::lost(s.t, s.loss->bound, g.table.bound(l.id, s.t));
}

/// Takes over a bound that is less than what is there, which NaN is not.
inline void offer(double bound, CertificateKind kind, Report& r) noexcept {
  if (r.bound <= bound || !(bound < kInfinity)) return;
  r.bound = bound;
  r.kind = kind;
}

inline void offer_table(const Local& l, const Gains& g, const Memory& s, Report& r) noexcept {
  offer(g.table.bound(l.id, s.t), CertificateKind::table, r);
  if (s.full >= 0) offer(g.table.bound_after(l.id, s.t, s.which, s.full), CertificateKind::informed, r);
}

}  // namespace garrison::saturation
