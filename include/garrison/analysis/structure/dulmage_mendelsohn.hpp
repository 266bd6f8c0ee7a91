// SPDX-License-Identifier: Apache-2.0
// Dulmage-Mendelsohn decomposition: which part of a pattern lacks rows, which lacks columns.
#pragma once

#include <span>
#include <vector>

#include "garrison/analysis/structure/matching.hpp"

namespace garrison::structure {

/// Rows and columns in three coarse parts, which do not depend on the matching, and the square part in fine
/// blocks that no permutation splits further.
struct GARRISON_EXPORT Decomposition {
  std::vector<int> hor_rows, hor_cols;  ///< more columns than rows: what unmatched columns reach
  std::vector<int> sq_rows, sq_cols;    ///< matched with each other; fine blocks one behind the other
  std::vector<int> ver_rows, ver_cols;  ///< more rows than columns: what unmatched rows reach
  /// Fine block b holds sq_rows and sq_cols [block_start[b], block_start[b+1]). Entries outside of the blocks
  /// lie in rows of an earlier block (block upper triangular).
  std::vector<int> block_start{0};
  Matching matching;

  int structural_rank() const { return matching.size; }
  int blocks() const { return static_cast<int>(block_start.size()) - 1; }
};

/// All of it, O(entries) after the matching. Members of the coarse parts come in the order of the search.
GARRISON_EXPORT Decomposition dulmage_mendelsohn(const Pattern& pattern);
GARRISON_EXPORT Decomposition dulmage_mendelsohn(const Pattern& pattern, Matching matching);

/// Columns reachable from `from` by column -> any of its rows -> the column matched to that row, `from`
/// first. For an unmatched column it is a contraction: the least set Z of columns with fewer rows than
/// columns.
std::vector<int> reachable_columns(const Pattern& pattern, const Matching& matching,
                                   std::span<const int> from);

/// The contractions (one per unmatched column) depend on the matching; which of them overlap does not.
/// Connected components of the overlaps: sorted lists of columns.
GARRISON_EXPORT std::vector<std::vector<int>> contraction_components(const Pattern& pattern,
                                                                     const Decomposition& parts);

}  // namespace garrison::structure
