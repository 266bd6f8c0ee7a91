// SPDX-License-Identifier: Apache-2.0
// Which modes the outputs show: the one decision on observability and detectability of the library.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "garrison/core/model.hpp"

namespace garrison {

/// Answer to "does some output show every mode?". `unclear`: the numbers given cannot tell, because a pair
/// that differs from them by little more than rounding has an unseen mode.
enum class Sight { seen, unseen, unclear };

/// What (A, C) shows of the modes of modulus >= least.
struct GARRISON_EXPORT Visibility {
  Sight sight = Sight::seen;
  /// How far the nearest pair with an unseen mode is: least singular value of [A - z I; C] over |z| >= least,
  /// relative to the size of the pair, in the units given where it is above 1e-4 there, otherwise in units of
  /// the pair's own (states and outputs balanced), which are the same whatever units are given. The
  /// search starts at all eigenvalues and means of their clusters; a nearer pair elsewhere is not excluded.
  /// 0..1.
  double distance = 0.0;
  std::complex<double> nearest;              ///< the z of that distance
  std::vector<std::complex<double>> unseen;  ///< modes that no output shows, each as often as it is not shown
  std::vector<std::complex<double>> unclear;  ///< modes of which that cannot be told

  bool all_seen() const { return sight == Sight::seen; }
  std::string text() const;  ///< e.g. "cannot tell: distance 3e-13 at the mode 1"
};

/// least = 0: observable when all modes are seen; least = 1: detectable. Neither coordinates nor units of
/// states and outputs matter: the pair is balanced first, and entries that are rounding only decide nothing.
/// Up to 4 n eps, at most 500 eps, (relative distance) counts as unseen, up to 16000 n^1.5 eps, at most
/// 1e-10, is unclear; in between, up to 16 n^1.5 eps, it is unseen if it counts as that in some units. What
/// would be seen if very small entries were large is unclear, not unseen. A: n x n, n >= 1. C: m x n, m >= 0.
/// About one QR decomposition of n columns per mode. Popov, Belevitch, Hautus; distance: Eising, Systems &
/// Control Letters 1984. @throws InvalidInput
GARRISON_EXPORT Visibility visibility(const MatrixRef& A, const MatrixRef& C, double least);

/// Modes of modulus >= least that are not surely seen: unseen and unclear ones of visibility().
GARRISON_EXPORT std::vector<std::complex<double>> unseen_modes(const MatrixRef& A, const MatrixRef& C,
                                                               double least);

/// Agents whose sensor alone can lie along a mode of modulus >= 1 that nobody else surely sees: that lie
/// moves like the plant itself, so no detector of any kind can find it. A mode that this agent does not see
/// either cannot be hidden behind it. Sorted.
GARRISON_EXPORT std::vector<int> undetectable_agents(const Model& model);

}  // namespace garrison
