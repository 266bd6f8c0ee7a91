// SPDX-License-Identifier: Apache-2.0
// Static meters (a power grid's flows and injections): which are critical, how many may be removed or lie,
// and the smallest attack that nobody can see.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

struct Meters {
  Vector leverage;            ///< per source, 0..1: 1 = nobody checks it
  std::vector<int> critical;  ///< sources with leverage 1: an attack on one of them alone is not seen
  /// bound[k]: what any k sources hold of the information at most, k = 0..min(sources, 12).
  std::vector<double> bound;
  int removable = 0;  ///< any so many may be missing: the rest still determines the state (a lower bound)
  int liars() const { return removable / 2; }  ///< any so many may lie and are contradicted
};

/// H: meters x n, rows divided by their deviations (or of length 1: the rank does not depend on it; take the
/// better), the reference removed. source: of each row, 0.., or empty: its position. O(rows^2 n).
/// @throws InvalidInput also when the rows do not determine the state
GARRISON_EXPORT Meters meters(const MatrixRef& H, std::span<const int> source = {});

struct SmallestAttack {
  std::optional<int> size;  ///< of the smallest set of meters with an undetectable attack; none found: absent
  std::vector<int> example;  ///< such a set
  int searched = 0;  ///< there is none of this size or smaller, for certain (size - 1 when one is found)
};

/// Exact search up to `most` >= 1 meters, by eigenvectors of the hat matrix; `tries`: sets that are looked at
/// before it gives up with what is certain so far, as it does when current_budget() is over. H as for
/// meters(); its rows must not be 0.
/// @throws InvalidInput
GARRISON_EXPORT SmallestAttack smallest_undetectable(const MatrixRef& H, int most, double tries = 1e7);

}  // namespace garrison::certificate
