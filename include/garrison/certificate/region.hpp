// SPDX-License-Identifier: Apache-2.0
// Where the state is: what every witness gives and every relay passes on. Definitions and proofs of all
// certificates: docs/certificates.md.
#pragma once

#include <cmath>

#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// ||x - center|| <= radius, and per coordinate |x_k - center_k| <= box_k where `box` is not empty, and
/// (x - center)' shape^-1 (x - center) <= stretch^2 where `shape` is not empty: n x n, positive semidefinite;
/// x - center lies in its range. All three hold together. The ball mixes the units of the coordinates: where
/// there is a box, report the box.
///
/// Two kinds of "no answer", never mixed: radius = infinity: the rows at hand cannot answer; radius = NaN:
/// the data refute the assumption that at most s sources are attacked (or the rare event of the noise
/// happened). `center` is meaningless for both.
struct Region {
  Vector center;
  double radius = kInfinity;
  Vector box;
  Matrix shape{};
  double stretch = kInfinity;

  bool answered() const { return std::isfinite(radius); }
  bool refuted() const { return std::isnan(radius); }
};

/// Bound on ||estimate - x|| for ANY estimate: ||estimate - center|| + radius, or by the box where that is
/// less. Infinity without an answer, NaN when refuted. Does not allocate.
inline double bound_around(const Region& region, const VectorRef& estimate) {
  if (!region.answered()) return region.radius;
  const double ball = (estimate - region.center).norm() + region.radius;
  if (region.box.size() == 0) return ball;
  return std::fmin(ball, ((estimate - region.center).cwiseAbs() + region.box).norm());
}

}  // namespace garrison::certificate
