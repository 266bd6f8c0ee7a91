// SPDX-License-Identifier: Apache-2.0
// Quadratic forms of up to three numbers that are not negative. Internal.
#pragma once

#include <cmath>

#include "garrison/core/types.hpp"

namespace garrison::detail {

/// A matrix of at most 3 x 3, without allocation.
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// t'R t >= 0 for all t >= 0; R symmetric (K. P. Hadeler, On copositive matrices, 1983).
inline bool copositive(const Small& R) {
  const Eigen::Index n = R.cols();
  double root[3] = {};
  for (Eigen::Index j = 0; j < n; ++j) {
    if (!(R(j, j) >= 0.0)) return false;
    root[j] = std::sqrt(R(j, j));
  }
  double product = 2.0;  // of what every two leave
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index k = j + 1; k < n; ++k) {
      const double rest = R(j, k) + root[j] * root[k];
      if (!(rest >= 0.0)) return false;
      product *= rest;
    }
  if (n < 3) return true;
  return root[0] * root[1] * root[2] + R(0, 1) * root[2] + R(0, 2) * root[1] + R(1, 2) * root[0] +
             std::sqrt(product) >=
         0.0;
}

/// Least t'Q t / t'G t over t >= 0, from below, and 0 where it is negative. G: ones on the diagonal, no
/// entry below 0. Errors of the entries of Q count in full, however close to singular G is.
inline double least_ratio(const Small& Q, const Small& G) {
  double low = 0.0;
  double high = Q.diagonal().minCoeff();
  if (!copositive(Q)) return low;
  if (copositive(Q - high * G)) return high;
  for (int step = 0; step < 56; ++step) {
    const double level = 0.5 * (low + high);
    (copositive(Q - level * G) ? low : high) = level;
  }
  return low;
}

}  // namespace garrison::detail
