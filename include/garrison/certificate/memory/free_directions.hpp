// SPDX-License-Identifier: Apache-2.0
// Directions in which nothing is known of a state yet.
#pragma once

#include "garrison/core/types.hpp"

namespace garrison::certificate::detail {

/// Of an error, the part U d with any d: the first `count` columns of U, orthonormal in the product sum_i
/// weight_i u_i v_i. Nothing allocates but `resize`.
struct FreeDirections {
  Matrix U{};  ///< n x n
  int count = 0;

  template <class V>
  void visit(V& v) {
    v("U", U);
    v.range("count", count, 0, U.cols());
  }

  void resize(Eigen::Index n) { U.setZero(n, n); }
  /// Nothing is known at all.
  void all(const VectorRef& weight) noexcept;
  /// One more; false, and undecided what is free, where it is none beside the others up to rounding, or not
  /// finite.
  bool add(const VectorRef& u, const VectorRef& weight) noexcept;
  /// A step of the plant; room: n numbers.
  void advance(const MatrixRef& A, const VectorRef& weight, Vector& room) noexcept;
  /// What a row saw, seen = (U_1 .. U_count)'h, is known now. `seen` is used up.
  void fix(Eigen::Ref<Vector> seen) noexcept;

 private:
  void orthonormalise(const VectorRef& weight) noexcept;
};

}  // namespace garrison::certificate::detail
