// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/observability.hpp"

#include <algorithm>
#include <functional>

#include "core/solvers.hpp"
#include "garrison/analysis/subsets.hpp"
#include "row_groups.hpp"

namespace garrison {

bool observable(const MatrixRef& A, const MatrixRef& C) {
  const auto n = A.rows();
  if (A.cols() != n || C.cols() != n)
    refuse("C", std::to_string(C.rows()) + " x " + std::to_string(C.cols()), "as many columns as A has rows");
  if (C.rows() == 0) return false;
  Matrix O(C.rows() * n, n);
  Matrix block = C;
  for (Eigen::Index k = 0; k < n; ++k, block = block * A) O.middleRows(k * C.rows(), C.rows()) = block;
  const Vector values = Eigen::JacobiSVD<Matrix>(O).singularValues();
  const double zero = static_cast<double>(std::max(O.rows(), O.cols())) * 2.220446049250313e-16 * values(0);
  return (values.array() > zero).count() == n;
}

bool s_sparse_observable(const MatrixRef& A, const MatrixRef& C, int s) {
  detail::require_subset_input("s_sparse_observable", C, s);
  const auto groups = detail::group_rows(C);
  // Copies add nothing to the rank: only which groups vanish entirely matters.
  const std::size_t G = groups.members.size();
  std::vector<char> gone(G, 0);
  double tried = 0.0;
  const std::function<bool(std::size_t, int)> all_observable = [&](std::size_t k, int left) -> bool {
    if (k == G) {
      if (++tried > kMostRemovals)
        refuse("s_sparse_observable", "more than " + text(kMostRemovals) + " sets to try",
               "a smaller s or N");
      Matrix kept(0, C.cols());
      for (std::size_t g = 0; g < G; ++g)
        if (!gone[g]) {
          kept.conservativeResize(kept.rows() + 1, Eigen::NoChange);
          kept.row(kept.rows() - 1) = C.row(groups.members[g].front());
        }
      return observable(A, kept);
    }
    const int size = static_cast<int>(groups.members[k].size());
    if (size <= left) {
      gone[k] = 1;
      const bool fine = all_observable(k + 1, left - size);
      gone[k] = 0;
      if (!fine) return false;
    }
    return all_observable(k + 1, left);
  };
  return all_observable(0, s);
}

bool one_step_sparse_observable(const MatrixRef& C, int s) {
  return s < C.rows() && lambda0(C, s).lower > 1e-9;
}

}  // namespace garrison
