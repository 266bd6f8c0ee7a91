// SPDX-License-Identifier: Apache-2.0
#include "extended.hpp"

#include <cmath>

namespace garrison::detail {

using Eigen::Index;

Extended product(const Extended& a, const Extended& b) { return a.lazyProduct(b); }

Extended congruence(const Extended& a, const Extended& b) {
  return a.lazyProduct(b).eval().lazyProduct(a.transpose());
}

Extended inverse_root(const Extended& S) {
  // S = L L', then L^-1 by forward substitution.
  const Index n = S.rows();
  Extended L = Extended::Zero(n, n);
  for (Index j = 0; j < n; ++j)
    for (Index i = j; i < n; ++i) {
      long double left = S(i, j);
      for (Index k = 0; k < j; ++k) left -= L(i, k) * L(j, k);
      L(i, j) = i == j ? std::sqrt(left) : left / L(j, j);
    }
  Extended R = Extended::Zero(n, n);
  for (Index c = 0; c < n; ++c)
    for (Index i = c; i < n; ++i) {
      long double left = i == c ? 1.0L : 0.0L;
      for (Index k = c; k < i; ++k) left -= L(i, k) * R(c, k);
      R(c, i) = left / L(i, i);
    }
  return R;
}

}  // namespace garrison::detail
