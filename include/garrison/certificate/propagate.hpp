// SPDX-License-Identifier: Apache-2.0
// A region of some steps ago as a region of today: x(t) = A^k x(t-k) + noise of k steps.
#pragma once

#include <vector>

#include "garrison/certificate/region.hpp"
#include "garrison/core/error.hpp"

namespace garrison::certificate {

/// Regions of ages 0..steps, prepared once so that ageing one at run time costs O(n^2) and does not allocate.
class GARRISON_EXPORT Propagation {
 public:
  /// ||w|| <= bw. A: n x n, finite; bw >= 0; steps >= 0. @throws InvalidInput
  static Propagation bounded(const MatrixRef& A, int steps, double bw);
  /// w ~ N(0, Q), white: one quantile for all k steps of an age; fails with probability delta per use. To
  /// choose the best of several ages by looking at the data, give each its share of delta. Q: n x n,
  /// symmetric, positive semidefinite. @throws InvalidInput
  static Propagation gaussian(const MatrixRef& A, int steps, const MatrixRef& Q, double delta);

  int states() const { return static_cast<int>(power_.front().rows()); }
  int steps() const { return static_cast<int>(power_.size()) - 1; }
  /// `now` becomes the region of today for `then`, which held `age` steps ago; another object than `then`.
  /// The box is not carried over (`now.box` is emptied). A region without an answer stays as it is. Expects 0
  /// <= age <= steps.
  void age(const Region& then, int age, Region& now) const noexcept;
  /// Checked, with an object of its own. @throws InvalidInput for another dimension or an age out of range
  Region age(const Region& then, int age) const;

 private:
  Propagation(const MatrixRef& A, int steps);
  std::vector<Matrix> power_;  // A^k
  std::vector<double> norm_;   // ||A^k||
  std::vector<double> added_;  // radius that k steps of noise add
};

}  // namespace garrison::certificate
