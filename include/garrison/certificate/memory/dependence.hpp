// SPDX-License-Identifier: Apache-2.0
// Whether what should be white noise remembers its past: evidence that grows sample by sample, any of which
// may be missing. docs/certificates.md, section 9.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// What speaks against "each of these numbers is N(0, 1), whatever those before it are".
struct Dependence {
  /// Where that is true, this ever exceeds any e with probability at most exp(-e).
  double evidence = -kInfinity;
  int source = -1;           ///< of the row that it is about; -1 = nothing was compared
  double correlation = 0.0;  ///< of neighbours
  double pairs = 0.0;        ///< so many of them

  template <class V>
  void visit(V& v) {
    v("evidence", evidence);
    v.range("source", source, -1, INT32_MAX);
    v("correlation", correlation);
    v("pairs", pairs);
  }
};

/// Of all starts of a bank before the present one.
struct PastDependence {
  Dependence most{};
  std::int64_t starts = 0;  ///< so many, in which something was compared

  template <class V>
  void visit(V& v) {
    v("most", most);
    v.range("starts", starts, 0, INT64_MAX / 4);
  }
};

namespace detail {

inline PastDependence with_start(const PastDependence& past, const Dependence& now) noexcept {
  return now.source < 0 ? past : PastDependence{now, past.starts + 1};
}

/// What is kept of a row: the last number, and sums over pairs of neighbours. A column of so many numbers.
enum : Eigen::Index { kLast, kProducts, kSquares, kPairs, kHeard };

inline Matrix nothing_heard(Eigen::Index rows) {
  Matrix heard = Matrix::Zero(kHeard, rows);
  heard.row(kLast).setConstant(kNaN);
  return heard;
}
inline void hear_nothing(Matrix& heard) noexcept {
  heard.setZero();
  heard.row(kLast).setConstant(kNaN);
}
/// The next number of a row; NaN = missing.
inline void hear(Matrix& heard, Eigen::Index row, double e) noexcept {
  const double last = heard(kLast, row);
  heard(kLast, row) = e;
  if (std::isnan(e) || std::isnan(last)) return;
  heard(kProducts, row) += e * last;
  heard(kSquares, row) += last * last;
  heard(kPairs, row) += 1.0;
}

/// Of one row. With e ~ N(0, 1) given its past, exp(l S - l^2 V / 2) is a martingale for every l (S the sum
/// of the products, V of the squares of the earlier ones), and so is its mean over l ~ N(0, kSpread), of
/// which this is the logarithm where `size` is 1. A mean square above 1 makes it less: noise that is only
/// larger than modelled is told elsewhere.
inline Dependence dependence(const Matrix& heard, Eigen::Index row) noexcept {
  constexpr double kSpread = 0.25;
  const double S = heard(kProducts, row);
  const double V = heard(kSquares, row);
  const double pairs = heard(kPairs, row);
  if (!(pairs > 0.0 && V > 0.0)) return {};
  const double size = std::max(1.0, V / pairs);
  const double room = 1.0 + kSpread * V;
  return {0.5 * (kSpread * S * S / (size * room) - std::log(room)), -1, S / V, pairs};
}

}  // namespace detail
}  // namespace garrison::certificate
