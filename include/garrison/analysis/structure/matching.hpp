// SPDX-License-Identifier: Apache-2.0
// Maximum matching of the columns of a pattern with its rows: the structural rank and who is left over.
#pragma once

#include <span>
#include <vector>

#include "garrison/analysis/structure/pattern.hpp"

namespace garrison::structure {

/// Which row each column is matched to, and the other way round; -1 = unmatched.
struct GARRISON_EXPORT Matching {
  std::vector<int> row_of;
  std::vector<int> column_of;
  int size = 0;
};

/// A maximum matching; its size is the structural rank. Depth-first augmenting paths as long as they stay
/// cheap (nearly full rank), else Karp-Sipser's start and phases of disjoint paths (deficient patterns). No
/// recursion.
GARRISON_EXPORT Matching maximum_matching(const Pattern& pattern);

/// A maximum matching that leaves the columns in `last` unmatched wherever it can, the later ones first: the
/// other columns are matched as far as possible, then these in their order. Which columns are matched is then
/// the lexicographically first choice (transversal matroid).
GARRISON_EXPORT Matching maximum_matching(const Pattern& pattern, std::span<const int> last);

/// Augmenting paths from single columns, on a matching of its own. Iterative; all memory is taken once.
class GARRISON_EXPORT Augmenter {
 public:
  /// `pattern` must outlive this.
  Augmenter(const Pattern& pattern, Matching start);
  explicit Augmenter(const Pattern& pattern);

  /// Tries to match `column` (unmatched) by an augmenting path; matched columns stay matched.
  bool augment(int column);
  /// Entries looked at by all searches so far.
  long long work() const { return work_; }
  /// Removes a row: nothing is matched to it any more, now or later. Its column becomes unmatched.
  void remove_row(int row);
  const Matching& matching() const { return matching_; }
  Matching take() { return std::move(matching_); }

 private:
  const Pattern* pattern_;
  Matching matching_;
  std::vector<int> free_from_;  // per column: its entries before this one are matched rows
  std::vector<int> next_;       // per column on the path: entry to descend to next
  std::vector<int> stamp_;      // per column: search that visited it, or dead
  std::vector<int> path_;
  std::vector<int> visited_;
  int search_ = 0;
  long long work_ = 0;
};

}  // namespace garrison::structure
