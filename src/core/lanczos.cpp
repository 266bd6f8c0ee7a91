// SPDX-License-Identifier: Apache-2.0
#include "core/lanczos.hpp"

#include <algorithm>
#include <cmath>

#include "core/solvers.hpp"
#include "garrison/core/budget.hpp"

namespace garrison::detail {

constexpr double kRounding = 1e-15;

Ritz largest_eigenvalue(Eigen::Index size, double accuracy, int most,
                        const std::function<Vector(const Vector&)>& apply, double enough) {
  const auto deflate = [](Vector& v) { v.array() -= v.mean(); };
  Vector q(size);
  for (Eigen::Index i = 0; i < size; ++i) q(i) = std::sin(1.0 + 12.9898 * static_cast<double>(i));
  deflate(q);
  q.normalize();
  const int steps = static_cast<int>(std::min<Eigen::Index>(most, size - 1));
  Matrix basis(size, steps);
  Vector alpha = Vector::Zero(steps);
  Vector beta = Vector::Zero(steps);
  Ritz found;
  for (int k = 0; k < steps && !found.settled; ++k) {
    require_time("the eigenvalues of the network");
    basis.col(k) = q;
    Vector r = apply(q);
    alpha(k) = q.dot(r);
    for (int pass = 0; pass < 2; ++pass) {
      r -= basis.leftCols(k + 1) * (basis.leftCols(k + 1).transpose() * r);
      deflate(r);  // after it, or what rounding adds would grow where all-ones is the largest eigenvector
    }
    beta(k) = r.norm();
    const bool whole = beta(k) <= kRounding * std::abs(alpha(k));  // the basis holds all there is
    if (k % 8 == 7 || k + 1 == steps || whole) {
      Eigen::SelfAdjointEigenSolver<Matrix> ritz;
      ritz.computeFromTridiagonal(alpha.head(k + 1), beta.head(k), Eigen::ComputeEigenvectors);
      found.value = ritz.eigenvalues()(k);
      if (found.value > enough) return found;  // it only grows
      found.settled =
          whole || beta(k) * std::abs(ritz.eigenvectors()(k, k)) <= accuracy * std::abs(found.value);
    }
    q = r / beta(k);
  }
  return found;
}

}  // namespace garrison::detail
