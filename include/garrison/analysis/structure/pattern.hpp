// SPDX-License-Identifier: Apache-2.0
// The zero pattern of a matrix, column by column: all that a structural statement needs.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::structure {

/// Which entries of a rows x columns matrix are not zero. Column j lists its rows; of a system matrix A the
/// entry (i, j) is the link j -> i of the system digraph, so column j lists the states that j drives.
/// Up to 2^31 - 1 entries; an entry given twice counts once.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Pattern {
 public:
  Pattern() = default;
  /// `entries`: (column, row) pairs. @throws InvalidInput when a size is negative or an index out of range.
  Pattern(int rows, int columns, std::span<const std::pair<int, int>> entries);
  /// Compressed columns as they are: start (columns + 1) and rows, in any order, without doubles.
  /// @throws InvalidInput when the arrays do not fit together.
  Pattern(int rows, std::vector<int> start, std::vector<int> index);
  /// Entries with |M(i, j)| > tolerance >= 0; a number that is not finite is refused.
  static Pattern of(const MatrixRef& M, double tolerance = 0.0);

  int rows() const { return rows_; }
  int columns() const { return static_cast<int>(start_.size()) - 1; }
  int entries() const { return start_.back(); }
  const int* start() const { return start_.data(); }
  const int* index() const { return index_.data(); }
  std::span<const int> column(int j) const {
    const auto first = static_cast<std::size_t>(start_[static_cast<std::size_t>(j)]);
    return std::span(index_).subspan(
        first, static_cast<std::size_t>(start_[static_cast<std::size_t>(j) + 1]) - first);
  }
  Pattern transposed() const;
  /// This pattern with one more row per list of columns in `below`.
  Pattern stacked(std::span<const std::vector<int>> below) const;

 private:
  int rows_ = 0;
  std::vector<int> start_{0};
  std::vector<int> index_;
};

}  // namespace garrison::structure
