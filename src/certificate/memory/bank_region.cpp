// SPDX-License-Identifier: Apache-2.0
// Box, ellipsoid and ball around all that the living members of a bank allow.
#include <algorithm>
#include <cmath>

#include "ellipsoid_union.hpp"
#include "garrison/certificate/memory/bank.hpp"

namespace garrison::certificate {

void Bank::enclose(const WindowLevels& z, bool ellipsoid) noexcept {
  Region& region = witness_.region;
  hull(z);
  region.stretch = kInfinity;
  if (ellipsoid) enclose_by_ellipsoid(z);
  region.radius = std::min(ball(z), region.box.norm());
  if (!std::isfinite(region.radius) || !region.center.allFinite())  // overflow of an unstable plant
    region.radius = region.stretch = kInfinity;
}

void Bank::hull(const WindowLevels& z) noexcept {
  Region& region = witness_.region;
  const auto half = [&](const BankMember& m, Eigen::Index i) {
    return z.zc * std::sqrt(std::max(m.P(i, i), 0.0)) + m.Psi.row(i).norm();
  };
  for (Eigen::Index i = 0; i < states(); ++i) {
    double lo = kInfinity;
    double hi = -kInfinity;
    for (const BankMember& m : members()) {
      lo = std::min(lo, m.c(i) - half(m, i));
      hi = std::max(hi, m.c(i) + half(m, i));
    }
    region.center(i) = 0.5 * (lo + hi);
    region.box(i) = 0.5 * (hi - lo);
  }
}

void Bank::enclose_by_ellipsoid(const WindowLevels& z) noexcept {
  Region& region = witness_.region;
  double most = -1.0;
  for (const BankMember& m : members()) {
    sum_ = m.Psi.lazyProduct(m.Psi.transpose());
    sum_ += m.P;
    if (!(sum_.trace() > most)) continue;
    most = sum_.trace();
    region.shape = sum_;
  }
  frame_->set(region.shape);
  region.stretch = 0.0;
  for (const BankMember& m : members()) {
    v_ = m.c - region.center;
    region.stretch =
        std::max(region.stretch, frame_->length(v_) + z.z2 * frame_->stretch(m.P) + frame_->norm(m.Psi));
  }
}

/// Radius of a ball around the region's centre and all members.
double Bank::ball(const WindowLevels& z) noexcept {
  const auto largest = [&](const Matrix& P) {
    return std::sqrt(std::max(frame_->eigenvalues(P).second, 0.0));
  };
  double radius = 0.0;
  for (const BankMember& m : members()) {
    v_ = m.c - witness_.region.center;
    const double off = v_.norm();
    const double most = std::sqrt(std::max(m.P.trace(), 0.0));
    if (!(most < std::sqrt(kHuge))) return kInfinity;  // its square has to be a number
    if (off + z.z2 * most + m.Psi.norm() <= radius) continue;
    double set = 0.0;
    if (m.Psi.cols() > 0) {
      sum_ = m.Psi.lazyProduct(m.Psi.transpose());
      set = largest(sum_);
    }
    radius = std::max(radius, off + z.z2 * largest(m.P) + set);
  }
  return radius;
}

}  // namespace garrison::certificate
