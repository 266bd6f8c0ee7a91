// SPDX-License-Identifier: Apache-2.0
// Interval rule per coordinate: over cells of sensors (C), over neighbours some of whom lie, and over several
// regions that hold together.
#pragma once

#include <span>

#include "garrison/certificate/interval.hpp"
#include "garrison/certificate/region.hpp"

namespace garrison::certificate {

/// lo_i <= x_i <= hi_i, n numbers each. (NaN, NaN): refuted; infinite: cannot be told.
struct Box {
  Vector lo, hi;
};

/// Per coordinate the hull of the points in at least (regions - s) of the boxes. Regions of disjoint cells of
/// sources, at most s of which are touched by an attack (C: local filters, box_i = z sqrt(P_ii) with z at
/// delta / (cells n); their honest errors may be correlated), or of distinct neighbours, at most s of whom
/// lie. (NaN, NaN): more than s are wrong; infinite: not enough of them. A region without
/// an answer counts as one without limits; a refuted one as wrong. The box must be there, or a ball stands in
/// for it.
/// @throws InvalidInput for no region, dimensions that differ, s < 0
GARRISON_EXPORT Box cells(std::span<const Region> regions, int s);

/// All regions hold on the same event: the intersection of their boxes, with its middle as the centre and the
/// ball around it; refuted when it is empty. Regions without an answer say nothing; a refuted one refutes.
/// @throws InvalidInput for no region or dimensions that differ
GARRISON_EXPORT Region intersection(std::span<const Region> regions);

/// Order rule per coordinate: of these regions at most f are wrong; |estimate_i - x_i| is at most the
/// (f+1)-th smallest of |estimate_i - center_i| + box_i. n numbers; infinite with f or fewer. @throws
/// InvalidInput
GARRISON_EXPORT Vector order_rule(std::span<const Region> regions, const VectorRef& estimate, int f);

}  // namespace garrison::certificate
