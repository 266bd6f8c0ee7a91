// SPDX-License-Identifier: Apache-2.0
// Eigenvalues of symmetric matrices, compiled once: Eigen's solver per fixed dimension costs minutes and
// gigabytes of compilation, and the bounded one is as fast.
#pragma once

#include "garrison/core/types.hpp"

namespace garrison::detail {

/// S: symmetric n x n, column by column. Writes n eigenvalues in ascending order and, unless null, the n x n
/// orthonormal eigenvectors. Does not allocate for n <= 8.
void symmetric_eigen(const double* S, Eigen::Index n, double* values, double* vectors = nullptr);

template <int n>
Vec<n> eigenvalues(const Mat<n>& S) {
  Vec<n> values(S.cols());
  symmetric_eigen(S.data(), S.cols(), values.data());
  return values;
}

}  // namespace garrison::detail
