// SPDX-License-Identifier: Apache-2.0
// One region around several: ellipsoid, box and ball of a union. Internal.
#pragma once

#include "garrison/certificate/region.hpp"
#include "shape_frame.hpp"

namespace garrison::certificate::detail {

/// Sets c, {d' P^-1 d <= r^2}, |d_i| <= box_i, collected and then enclosed. Sized once.
class EllipsoidUnion {
 public:
  EllipsoidUnion(int n, int capacity)
      : frame_(n),
        c_(n, capacity),
        box_(n, capacity),
        P_(n, static_cast<Eigen::Index>(n) * capacity),
        r_(capacity),
        away_(n) {}

  void clear() { size_ = 0; }
  int size() const { return size_; }
  int capacity() const { return static_cast<int>(c_.cols()); }
  ShapeFrame& frame() { return frame_; }
  void add(const VectorRef& c, const MatrixRef& P, double r, const VectorRef& box) {
    c_.col(size_) = c;
    P_.middleCols(n() * size_, n()) = P;
    r_(size_) = r;
    box_.col(size_) = box;
    ++size_;
  }
  /// The box of the union, and its middle as the centre.
  void hull(Region& region) const {
    for (Eigen::Index i = 0; i < n(); ++i) {
      const double lo = (c_.row(i).head(size_) - box_.row(i).head(size_)).minCoeff();
      const double hi = (c_.row(i).head(size_) + box_.row(i).head(size_)).maxCoeff();
      region.center(i) = 0.5 * (lo + hi);
      region.box(i) = 0.5 * (hi - lo);
    }
  }
  /// Ellipsoid of this shape, and ball, around a centre that is set. The ball is never larger than the box.
  void enclose(const Matrix& shape, Region& region) {
    region.shape = shape;
    frame_.set(shape);
    region.stretch = 0.0;
    region.radius = 0.0;
    for (int k = 0; k < size_; ++k) {
      const auto P = P_.middleCols(n() * k, n());
      away_ = c_.col(k) - region.center;
      region.stretch = std::max(region.stretch, frame_.length(away_) + r_(k) * frame_.stretch(P));
      region.radius = std::max(region.radius,
                               away_.norm() + r_(k) * std::sqrt(std::max(frame_.eigenvalues(P).second, 0.0)));
    }
    region.radius = std::min(region.radius, region.box.norm());
  }
  /// The largest of the ellipsoids (by its trace), stretched by the spread of the centres.
  void shape(const Region& region, Matrix& into) const {
    double most = -1.0;
    for (int k = 0; k < size_; ++k) {
      const auto P = P_.middleCols(n() * k, n());
      const double trace = r_(k) * r_(k) * P.trace();
      if (!(trace > most)) continue;
      most = trace;
      into = r_(k) * r_(k) * P;
    }
    if (size_ > 1)
      for (int k = 0; k < size_; ++k)
        for (Eigen::Index i = 0; i < n(); ++i)
          into.col(i) += (2.0 / size_ * (c_(i, k) - region.center(i))) * (c_.col(k) - region.center);
  }

 private:
  Eigen::Index n() const { return c_.rows(); }
  ShapeFrame frame_;
  Matrix c_, box_, P_;
  Vector r_, away_;
  int size_ = 0;
};

}  // namespace garrison::certificate::detail
