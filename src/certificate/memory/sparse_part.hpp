// SPDX-License-Identifier: Apache-2.0
// Rows of the hat matrix of a large sparse H, one at a time, by a factor of H'H. Internal.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "garrison/core/types.hpp"
#include "row_parts.hpp"

namespace garrison::certificate::detail {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using SparseGram = Eigen::SparseMatrix<double, Eigen::ColMajor>;

/// One part of H, whose rows have length 1: Lam = H (H'H)^-1 H'.
class SparsePart {
 public:
  SparsePart(RowPart part, SparseRows H);

  const std::vector<Eigen::Index>& rows() const { return part_.rows; }
  const std::vector<Eigen::Index>& columns() const { return part_.columns; }
  /// The smallest eigenvalue of H'H is at least this: the factor of H'H less it is positive. 0: not shown.
  double least() const { return least_; }
  bool determined() const { return least_ > 0.0; }

  /// Row i of Lam, each entry within the error that is returned. For a part that is determined.
  double hat_row(Eigen::Index i, Vector& out) const;
  /// Whether a change of the state is seen by these rows and by no other. For a part that is determined.
  bool needed(const std::vector<int>& set) const;

 private:
  double find_least() const;
  bool is_above(double shift) const;
  /// (H'H)^-1 h, refined until what is left of it cannot move an entry of Lam by more than `error`.
  Vector solve(const Vector& h, double& error) const;

  RowPart part_;
  SparseRows H_;
  SparseGram gram_;
  Eigen::SimplicialLDLT<SparseGram> factor_;
  double least_ = 0.0;
};

}  // namespace garrison::certificate::detail
