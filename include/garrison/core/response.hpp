// SPDX-License-Identifier: Apache-2.0
// What known inputs alone do to a plant: linear filters need to know no more of them (docs/adr/0016).
#pragma once

#include "garrison/core/model.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// s(t+1) = A s(t) + B u(t), s(0) = 0: filters get y - C s, and their estimates plus s are of the plant.
/// Threads: one at a time.
class GARRISON_EXPORT Response {
 public:
  explicit Response(const Model& model);

  /// s at the present sample, n numbers.
  const Vector& state() const { return s_; }
  std::int64_t sample() const { return t_; }
  /// Of the constant plant.
  const Matrix& A() const { return A_; }
  const Matrix& B() const { return B_; }
  /// Moves to the next sample. `u`: p finite numbers. @throws InvalidInput otherwise, or where s overflows
  void advance(const VectorRef& u);
  /// The same with other matrices, where the plant changes in time.
  void advance(const Matrix& A, const Matrix& B, const VectorRef& u);

 private:
  Matrix A_;
  Matrix B_;
  Vector s_;
  std::int64_t t_ = 0;
};

/// A x + B u, summed in the order of a plant whose state is (x, u): bits do not depend on which of them is
/// meant. @throws InvalidInput when sizes do not fit
GARRISON_EXPORT Vector driven(const Matrix& A, const Vector& x, const Matrix& B, const VectorRef& u);

}  // namespace garrison
