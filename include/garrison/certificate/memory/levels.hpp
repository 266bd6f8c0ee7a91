// SPDX-License-Identifier: Apache-2.0
// Quantiles that the certificates with memory take, and what they may assume.
#pragma once

#include <span>
#include <vector>

#include "garrison/certificate/quantiles.hpp"
#include "garrison/certificate/region.hpp"

namespace garrison::certificate {

/// In standard deviations: z1 for single rows and innovations, z2 for the vector of the state, zc for each of
/// its coordinates, z3 for all residuals of a subset together (NaN: not tested). All 0 with bounded noise.
struct WindowLevels {
  double z1 = kNaN;
  double z2 = kNaN;
  double zc = kNaN;
  double z3 = kNaN;
};

/// Levels of W2M, W3M and A that fail together with probability <= delta for one window: a third each for
/// three times `rows` single rows (noise, least-squares part, and the residual test of A), the vector and the
/// coordinates. For a bank: `rows` of one step. @throws InvalidInput for delta outside (0, 1) or sizes < 1
GARRISON_EXPORT WindowLevels window_levels(double delta, int rows, int states);

/// What a certificate with memory may assume.
struct WindowAssumption {
  int s = 0;  ///< at most s of ALL sources are attacked (moving: in each step); absent rows do not reduce it
  WindowLevels levels{};
  /// The attacked set may change from step to step; otherwise at most s sources in the whole window.
  bool moving = false;
  std::span<const int> proved{};  ///< known to be attacked, each once; not with `moving`
  std::span<const int> honest{};  ///< known to be honest, each once
};

/// A source shown to be attacked: in this step, or (kAlways) somewhere in the window.
struct Proof {
  int source;
  int step;
};
inline constexpr int kAlways = -1;

/// Answer of a certificate with memory.
struct WindowWitness {
  Region region;
  /// 1 - lambda of W2M: what is left of the information when the attackers take their share; 0 without an
  /// answer, NaN where it does not apply.
  double mu = kNaN;
  /// Sources whose rows were dropped, with those given. Where the region is refuted they prove nothing about
  /// any single source: there are more than s of them, or the rare event of the noise happened.
  std::vector<Proof> proofs;
  int count = 0;  ///< consistent subsets, leaves or living members behind the region
};

}  // namespace garrison::certificate
