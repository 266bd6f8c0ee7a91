// SPDX-License-Identifier: Apache-2.0
// The measurements of one sample that reached an agent, as the witnesses read them.
#pragma once

#include <span>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// Rows y = c x + v with a source each. A source (a sensor, or an agent with several outputs) is attacked or
/// honest as a whole. Sized once; `clear` and `add` do not allocate.
/// Threads: several may read; whoever changes it is alone, as with standard containers.
class GARRISON_EXPORT Rows {
 public:
  /// For at most `capacity` rows of sources 0..sources-1 and a state of `states` numbers, all >= 1.
  /// @throws InvalidInput for sizes < 1 or more than 1e8 numbers
  Rows(int states, int sources, int capacity);

  void clear();
  /// A row c (states numbers). `variance` weighs it; `width`: |v| <= width, read with bounded noise only. At
  /// most one measurement of an output. Returns false, and leaves it out, when it says nothing: y or c not
  /// finite or beyond kHuge, c = 0, variance not positive, width negative, no such source, or full. A row
  /// left out does not count as attacked.
  bool add(int source, std::span<const double> c, double y, double variance, double width = 0.0);
  /// Another measurement for a row that is there; finite and at most kHuge.
  void measure(int row, double y) { y_(row) = y; }
  /// Takes over the rows of `other`, as many as there is room for; whether these are other ones than before,
  /// measurements and widths aside. Of the same sizes.
  bool follow(const Rows& other);

  int states() const { return static_cast<int>(C_.rows()); }
  int sources() const { return static_cast<int>(count_.size()); }
  int capacity() const { return static_cast<int>(C_.cols()); }
  int size() const { return size_; }
  /// Sources that have a row.
  int present() const { return present_; }
  bool has(int source) const { return count_[static_cast<std::size_t>(source)] > 0; }

  int source(int row) const { return source_[static_cast<std::size_t>(row)]; }
  double y(int row) const { return y_(row); }
  double variance(int row) const { return variance_(row); }
  double width(int row) const { return width_(row); }
  /// c as a column.
  auto c(int row) const { return C_.col(row); }

 private:
  Matrix C_;  // states x capacity
  Vector y_, variance_, width_;
  std::vector<int> source_;  // of each row
  std::vector<int> count_;   // rows of each source
  int size_ = 0;
  int present_ = 0;
};

/// Rows from whole arrays, and which of them (positions in the arrays) were taken.
struct GivenRows {
  Rows rows;
  std::vector<int> position;  // of each row of `rows`
};

/// y: m, NaN = missing; C: m x n, finite; R: m variances > 0; widths: m bounds >= 0, or empty; sources: of
/// each row,
/// >= 0 and below 1e6, or empty = the position. @throws InvalidInput
GARRISON_EXPORT GivenRows given_rows(const VectorRef& y, const MatrixRef& C, const VectorRef& R,
                                     const VectorRef& widths, std::span<const int> sources);

}  // namespace garrison::certificate
