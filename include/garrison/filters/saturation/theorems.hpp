// SPDX-License-Identifier: Apache-2.0
// Error bounds of theorems 1, 3, 4, 5 and proposition 2. A bound that the theorem does not give is NaN (an
// empty list for bounds over time), never a number. All bounds are on ||xhat_i(t) - x(t)|| of every sensor i.
#pragma once

#include <vector>

#include "garrison/filters/saturation/constants.hpp"

namespace garrison::saturation {

/// Theorems 1 and 3 and proposition 2 with t0 = 1. Entry t-1 of a list belongs to time t = 1..T.
struct TheoremBounds {
  bool cond9 = false;              ///< (9); all members below are absent without it
  std::vector<double> thm1_item1;  ///< R(F(rho_1), t) + p(t)
  double thm1_item2 = kNaN;        ///< rho_1 + p0, for all t >= 1 (sup p(t) read as p0)
  double thm1_item3 = kNaN;        ///< lim rho_t + p0, for t -> infinity; lim rho_t in closed form
  double prop2_f = kNaN;           ///< f(s) of (13); the printed qbar0 is crude for a < 1
  double cond12_margin = kNaN;     ///< (beta - b_w - b_v)/a - (rho_1 + p0)
  bool cond12 = false;             ///< (12): margin > 0 beyond rounding (1e-12 relative)
  std::vector<double> thm3_item2;  ///< R(varpi, t) + p(t); absent without cond12, like the next
  double thm3_item3 = kNaN;        ///< q0/(1 - varpi) + p0, for t -> infinity; absent for varpi >= 1
};

/// `varpi`: theorem 3's, or an upper bound such as varpi_bound(); NaN = not known, theorem 3 is then absent.
/// `T` >= 1: length of the lists. @throws InvalidInput for a bad setting, varpi < 0 or T < 1
GARRISON_EXPORT TheoremBounds theorem_bounds(const Setting& setting, double varpi, int T);

/// a (1 - lambda0/N) >= varpi: no subset search needed (docs/filters/saturation.md#s-closed).
/// @throws InvalidInput
GARRISON_EXPORT double varpi_bound(const Setting& setting);

/// Theorem 4 when d of the s attackers are proved at time T.
struct DetectedBound {
  int d;
  double rho_T;         ///< rho_T of (7), where (17) starts
  double qbar;          ///< q0 - d beta / N of (17)
  double rhobar_limit;  ///< lim of (17)
  double F_star;        ///< F(rhobar_limit); Gammabar read as t >= T+1, where (17) has a predecessor
  double W;  ///< W(T) as printed; may rise with d for a < 1 (docs/filters/saturation.md#s13); NaN when F_star
             ///< >= 1
  double tight;  ///< rhobar_limit + p0 <= W, what the proof gives and never rises with d: use this one
};
/// Theorem 4 for d = 0..s; empty when (9) fails or a g >= 1. `T` >= 0.
/// @throws InvalidInput for a bad setting or T < 0
GARRISON_EXPORT std::vector<DetectedBound> theorem4(const Setting& setting, int T);

/// G of theorem 5, [[g11, g12], [g21, g22]] >= 0. Noise-free errors vanish when it is Schur, (9) holds and
/// all s attackers are proved. For a < 1 Schur does not follow from (9).
struct MatrixG {
  double g11, g12, g21, g22;
  double spectral_radius;
};
/// `tau0` >= 0 and `varpi` >= 0 as in theorem 5, or upper bounds. @throws InvalidInput
GARRISON_EXPORT MatrixG theorem5(const Setting& setting, double tau0, double varpi);

/// What theorem 1 does not cover: sensors that have proved all s attackers use their innovations in full, so
/// that lemma 2 (injections of at most beta) ends and consensus may overshoot (star of 8, a = 0.9: 12.34
/// above the 10.24 of theorem 1).
struct InformedBound {
  double uniform;     ///< ||error|| of every sensor at all t >= 1, detector included; NaN when radius >= 1
  double asymptotic;  ///< limsup of it, also when all attackers are proved; NaN like that
  double spectral_radius;  ///< of the recursion of (disagreement, mean error) once everybody knows
};
/// Disagreement p and mean error rho, from p0 and rho_1 of theorem 1, follow
///   p' = g (a p + sqrt(N-s) (a rho + b_w + b_v)),  rho' = x rho + y p + b_w + b_v (N-s)/N
/// with (x, y) = (a, a sqrt(N-s)/N) for `spread` samples, while the news spreads and gains are anything in
/// 0..1, and (varpi, tau0) after: proved sensors are silent, gains of honest ones are at most 1. No losses,
/// no delays. Absent (NaN) without (9). `spread` >= 0: diameter over L, rounded up. @throws InvalidInput as
/// theorem5
InformedBound informed_bound(const Setting& setting, double tau0, double varpi, int spread);

}  // namespace garrison::saturation
