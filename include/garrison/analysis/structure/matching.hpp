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

/// Augmenting paths from single columns, on a matching of its own. Iterative.
/// Threads: one at a time.
class Augmenter {
 public:
  /// `pattern` must outlive this.
  Augmenter(const Pattern& pattern, Matching start);
  explicit Augmenter(const Pattern& pattern);

  /// Tries to match `column` (unmatched) by an augmenting path; matched columns stay matched.
  bool augment(int column) { return matched_at_once(column) || search(column); }
  /// Entries looked at by all searches so far.
  long long work() const { return work_; }
  /// Removes a row: nothing is matched to it any more, now or later. Its column becomes unmatched.
  void remove_row(int row);
  int row_of(int column) const { return matching_.row_of[static_cast<std::size_t>(column)]; }
  int size() const { return matching_.size; }
  Matching matching() const { return Augmenter(*this).take(); }
  /// The matching, without a copy; this is of no use afterwards.
  Matching take();

 private:
  // What a search reads of a vertex lies side by side: it is the cache misses that cost.
  struct Column {
    int start;      // of its entries; they end where the next column starts
    int free_from;  // entries before this one are matched rows
  };
  struct Row {
    int column;  // it is matched to, or why there is none
    int stamp;   // search that passed it, or dead
  };
  struct Step {
    int column;
    int row;   // it is matched to; the column before it on the path may take that
    int next;  // entry to descend to next
    int end;
  };

  int free_row(int column);
  bool matched_at_once(int column);
  bool search(int column);
  void shift_path(int row);

  const int* index_;
  Matching matching_;  // its column_of is out of date until taken
  std::vector<Column> columns_;
  std::vector<Row> rows_;
  std::vector<Step> path_;
  std::vector<int> passed_;  // rows of this search
  int search_ = 0;
  long long work_ = 0;
};

}  // namespace garrison::structure
