// SPDX-License-Identifier: Apache-2.0
// A region of some steps ago as a region of today: x(t) = A^k x(t-k) + noise of k steps.
#pragma once

#include <vector>

#include "garrison/certificate/region.hpp"
#include "garrison/core/error.hpp"

namespace garrison::certificate {

/// Regions of ages 0..steps, prepared once so that ageing one at run time costs O(n^4) at most and does not
/// allocate. Box and ellipsoid are carried coordinate by coordinate (G): a mode that only drifts costs what
/// it drifts, not ||A^k||.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Propagation {
 public:
  /// ||w|| <= bw. A: n x n, finite; bw >= 0; steps >= 0. @throws InvalidInput
  static Propagation bounded(const MatrixRef& A, int steps, double bw);
  /// w ~ N(0, Q), white: one quantile for all k steps of an age; fails with probability delta per use. To
  /// choose the best of several ages by looking at the data, give each its share of delta. Q: n x n,
  /// symmetric, positive semidefinite. @throws InvalidInput
  static Propagation gaussian(const MatrixRef& A, int steps, const MatrixRef& Q, double delta);
  /// w = Gam w~ with |w~_i| <= bw for each entry. Gam: n x q. @throws InvalidInput
  static Propagation bounded_entries(const MatrixRef& A, int steps, const MatrixRef& Gam, double bw);
  /// w = Gam w~, w~ ~ N(0, I): zc for each coordinate, z2 for the vector; fails with probability <= n P(|N| >
  /// zc)
  /// + delta(z2) per use. @throws InvalidInput
  static Propagation gaussian_entries(const MatrixRef& A, int steps, const MatrixRef& Gam, double zc,
                                      double z2);

  int states() const { return static_cast<int>(power_.front().rows()); }
  int steps() const { return static_cast<int>(power_.size()) - 1; }
  /// For balls alone, 0 <= age <= steps(): ||A^age||, and what the noise adds to a radius.
  double norm(int age) const { return norm_[static_cast<std::size_t>(age)]; }
  double added(int age) const { return added_[static_cast<std::size_t>(age)]; }
  /// `now` becomes the region of today for `then`, which held `age` steps ago; another object than `then`. It
  /// has a box, the least of what ball, box and ellipsoid of `then` give, and an ellipsoid if `then` has one.
  /// Known inputs move the centre: add theirs. A region without an answer stays as it is. Expects 0 <= age <=
  /// steps.
  void age(const Region& then, int age, Region& now) const noexcept;
  /// Checked, with an object of its own. @throws InvalidInput for another dimension or an age out of range
  Region age(const Region& then, int age) const;

 private:
  Propagation(const MatrixRef& A, int steps);
  void add(double ball, const Vector& each, const Matrix& shape);
  std::vector<Matrix> power_;  // A^k
  std::vector<double> norm_;   // ||A^k||
  // What k steps of noise add: to the ball, to each coordinate, as an ellipsoid.
  std::vector<double> added_;
  std::vector<Vector> each_;
  std::vector<Matrix> shape_;
};

/// The region {x: (x - center)' shape^-1 (x - center) <= stretch^2}, with its box and ball. shape: n x n,
/// symmetric, positive semidefinite; stretch >= 0. @throws InvalidInput
GARRISON_EXPORT Region ellipsoid(const VectorRef& center, const MatrixRef& shape, double stretch);

}  // namespace garrison::certificate
