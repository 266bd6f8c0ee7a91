// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/modes.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "balance.hpp"
#include "unseen_part.hpp"

namespace garrison {
namespace {

using Index = Eigen::Index;

void require_pair(const MatrixRef& A, const MatrixRef& C) {
  const Index n = A.rows();
  if (n < 1 || A.cols() != n)
    refuse("A", std::to_string(n) + " x " + std::to_string(A.cols()),
           "a square matrix with at least one row");
  if (C.rows() > 0 && C.cols() != n)
    refuse("C", amount(C.cols(), "column"), std::to_string(n) + ", as many as A");
  if (!A.allFinite() || !C.allFinite()) refuse("A or C", "a number that is not finite", "finite numbers");
}

/// One cannot tell of any mode of which it says that it is unseen.
Visibility unclear(Visibility v) {
  v.sight = Sight::unclear;
  v.unclear.insert(v.unclear.end(), v.unseen.begin(), v.unseen.end());
  v.unseen.clear();
  return v;
}

std::string three_digits(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.3g", value);
  return buffer.data();
}

}  // namespace

std::string Visibility::text() const {
  constexpr double kReal = 1e-7;  // copies of a real mode are computed as complex pairs that far apart
  const std::string real = three_digits(nearest.real());
  const std::string mode =
      std::abs(nearest.imag()) <= kReal * std::abs(nearest)
          ? real
          : real + (nearest.imag() < 0.0 ? " - " : " + ") + three_digits(std::abs(nearest.imag())) + "i";
  const std::string at = "distance " + three_digits(distance) + " at the mode " + mode;
  switch (sight) {
    case Sight::seen:
      return "every mode is seen: " + at;
    case Sight::unseen:
      return "no output shows the mode " + mode;
    case Sight::unclear:
      return "cannot tell: " + at;
  }
  return at;
}

Visibility visibility(const MatrixRef& A, const MatrixRef& C, double least) {
  require_pair(A, C);
  if (!(least >= 0.0)) refuse("least", text(least), "a modulus >= 0");
  const auto [own_A, own_C] = detail::in_moderate_units(A, C.rows() > 0 ? Matrix(C) : Matrix(0, A.rows()));
  Visibility v = detail::examine(own_A, own_C, least);
  if (v.sight == Sight::unclear) return v;
  Matrix A_other = own_A;
  Matrix C_other = own_C;
  if (v.sight == Sight::unseen) {
    // What only entries show that are very small, but not 0, is not surely unseen.
    const bool small = detail::enlarge_small(A_other, C_other);
    return small && detail::examine(A_other, C_other, least).all_seen() ? unclear(std::move(v)) : v;
  }
  // Entries of the size of rounding must not be what makes a mode visible.
  if (!detail::drop_rounding(A_other, C_other)) return v;
  Visibility without = detail::examine(A_other, C_other, least);
  return without.all_seen() ? v : unclear(std::move(without));
}

std::vector<std::complex<double>> unseen_modes(const MatrixRef& A, const MatrixRef& C, double least) {
  Visibility v = visibility(A, C, least);
  v.unseen.insert(v.unseen.end(), v.unclear.begin(), v.unclear.end());
  return v.unseen;
}

}  // namespace garrison
