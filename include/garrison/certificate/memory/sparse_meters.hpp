// SPDX-License-Identifier: Apache-2.0
// What a static plant of many states withstands, from its sparse rows: no matrix of all states is made.
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

struct SparseMeters {
  /// Columns of which it is not sure that the rows determine them; where there are any, the rest is empty.
  std::vector<int> unseen;
  double least = 0.0;         ///< the smallest eigenvalue of H'H is at least this, for rows of length 1
  Vector leverage;            ///< per row, 0..1: 1 = nobody checks it; NaN: the time was up
  std::vector<int> critical;  ///< sources without which the rest does not determine the state
  bool complete = false;      ///< every row was looked at; else `critical` and `leverage` are not all
  /// The fewest rows without which the state is not determined are between `fewest` and `most`; `example`:
  /// `most` of them.
  int fewest = 1, most = 0;
  std::vector<int> example;
};

/// H: meters x n, x(k+1) = x(k); rows of zeros are no meters. They are scaled to length 1, which no answer
/// but `least` and `leverage` depends on. source: of each row, 0.., or empty: its position. A part of H (rows
/// with no state in common with the others) of up to `dense` >= 0 rows is searched exactly, as by
/// smallest_undetectable(), with `tries` sets; a larger one gives bounds from leverages. Ends with what is
/// certain when current_budget() is over. Memory: rows^2 of the largest part that is searched.
/// @throws InvalidInput
GARRISON_EXPORT SparseMeters sparse_meters(const Eigen::SparseMatrix<double, Eigen::RowMajor>& H,
                                           std::span<const int> source = {}, int dense = 4000,
                                           double tries = 1e12);

}  // namespace garrison::certificate
