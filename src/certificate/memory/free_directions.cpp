// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/free_directions.hpp"

#include <cmath>

namespace garrison::certificate::detail {
namespace {

/// What is left of a direction beside the others, of its length, when it is one of theirs up to rounding.
constexpr double kDependent = 1e-12;

double length(const VectorRef& u, const VectorRef& weight) {
  return std::sqrt((weight.array() * u.array().square()).sum());
}

}  // namespace

void FreeDirections::all(const VectorRef& weight) noexcept {
  U.setZero();
  U.diagonal().array() = weight.array().rsqrt();
  count = static_cast<int>(U.cols());
}

bool FreeDirections::add(const VectorRef& u, const VectorRef& weight) noexcept {
  const int before = count;
  if (before == U.cols() || !u.allFinite()) return false;
  U.col(count++) = u;
  orthonormalise(weight);
  return count == before + 1;
}

void FreeDirections::advance(const MatrixRef& A, const VectorRef& weight, Vector& room) noexcept {
  if (count == 0) return;
  for (int j = 0; j < count; ++j) {
    room = A.lazyProduct(U.col(j));
    U.col(j) = room;
  }
  orthonormalise(weight);
}

void FreeDirections::orthonormalise(const VectorRef& weight) noexcept {
  int kept = 0;
  for (int j = 0; j < count; ++j) {
    auto u = U.col(kept);
    if (kept != j) u = U.col(j);
    const double largest = u.cwiseAbs().maxCoeff();
    if (largest == 0.0) continue;
    u /= largest;
    u /= length(u, weight);
    for (int pass = 0; pass < 2; ++pass)
      for (int i = 0; i < kept; ++i) u -= (weight.array() * U.col(i).array() * u.array()).sum() * U.col(i);
    const double left = length(u, weight);
    if (!std::isfinite(left)) return all(weight);  // beyond all numbers: nothing is known
    if (left <= kDependent) continue;
    u /= left;
    ++kept;
  }
  count = kept;
}

void FreeDirections::fix(Eigen::Ref<Vector> seen) noexcept {
  // A reflection turns the first direction into the one that is seen, and the others into directions that are
  // not.
  const double all = seen.norm();
  seen(0) += seen(0) < 0.0 ? -all : all;
  const double square = seen.squaredNorm();
  for (Eigen::Index i = 0; i < U.rows(); ++i) {
    auto row = U.row(i).head(seen.size());
    const double along = 2.0 * row.dot(seen) / square;
    row -= along * seen.transpose();
  }
  --count;
  U.col(0) = U.col(count);
}

}  // namespace garrison::certificate::detail
