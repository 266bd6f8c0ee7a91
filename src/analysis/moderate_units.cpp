// SPDX-License-Identifier: Apache-2.0
// Balancing by exponents alone, for pairs whose squares are no doubles.
#include <algorithm>
#include <cmath>
#include <vector>

#include "balance.hpp"

namespace garrison::detail {
namespace {

using Index = Eigen::Index;

/// Powers of 2 up to which squares, and sums of them in units of the balance, are doubles.
constexpr double kModerate = 150.0;
constexpr int kMostSweeps = 60;

Matrix exponents(const Matrix& M) {
  return M.unaryExpr([](double x) { return x == 0.0 ? -kInfinity : std::log2(std::abs(x)); });
}

bool moderate(const Matrix& M) {
  return (M.array() == 0.0 ||
          (M.array().abs() < std::exp2(kModerate) && M.array().abs() > std::exp2(-kModerate)))
      .all();
}

/// Like Balancing (balance.cpp), with the largest entry of a row or column in place of the sum of squares.
class Exponents {
 public:
  Exponents(const Matrix& A, const Matrix& C)
      : A_(exponents(A)), C_(exponents(C)), goal_(std::log2(natural_rate(A))) {
    A_.diagonal().setConstant(-kInfinity);
    state_.assign(static_cast<std::size_t>(A.rows()), 0.0);
    output_.assign(static_cast<std::size_t>(C.rows()), 0.0);
    const auto order = from_outputs(A, C);
    first_pass(order);
    double moved = kInfinity;
    for (int sweep = 0; sweep < kMostSweeps && moved >= 0.5; ++sweep) {
      moved = 0.0;
      for (const Index j : order) moved = std::max(moved, settle(j));
      for (Index k = 0; k < C_.rows(); ++k) moved = std::max(moved, settle_output(k));
    }
  }
  int state(Index j) const { return static_cast<int>(std::round(state_[static_cast<std::size_t>(j)])); }
  int output(Index k) const { return static_cast<int>(std::round(output_[static_cast<std::size_t>(k)])); }

 private:
  double& of_state(Index j) { return state_[static_cast<std::size_t>(j)]; }
  double& of_output(Index k) { return output_[static_cast<std::size_t>(k)]; }

  /// Scales every output by its own row, then every state by what is nearer to the outputs.
  void first_pass(const std::vector<Index>& order) {
    for (Index k = 0; k < C_.rows(); ++k) settle_output(k);
    std::vector<Index> done;
    for (const Index j : order) {
      double strength = shown(j);
      for (const Index i : done) strength = std::max(strength, A_(i, j) - of_state(i));
      if (std::isfinite(strength)) of_state(j) = goal_ - strength;
      done.push_back(j);
    }
  }

  double shown(Index j) {
    double most = -kInfinity;
    for (Index k = 0; k < C_.rows(); ++k) most = std::max(most, C_(k, j) + of_output(k));
    return most;
  }

  double settle(Index j) {
    double column = shown(j);
    double row = -kInfinity;
    for (Index i = 0; i < A_.rows(); ++i) {
      column = std::max(column, A_(i, j) - of_state(i));
      row = std::max(row, A_(j, i) + of_state(i));
    }
    if (!std::isfinite(column)) return 0.0;
    return set(of_state(j), std::max(goal_ - column, 0.5 * (row - column)));
  }

  double settle_output(Index k) {
    double most = -kInfinity;
    for (Index j = 0; j < C_.cols(); ++j) most = std::max(most, C_(k, j) + of_state(j));
    return std::isfinite(most) ? set(of_output(k), goal_ - most) : 0.0;
  }

  static double set(double& scale, double value) {
    const double moved = std::abs(value - scale);
    scale = value;
    return moved;
  }

  Matrix A_, C_;  // log2 of the entries, A without its diagonal
  double goal_;
  std::vector<double> state_, output_;
};

}  // namespace

Pair in_moderate_units(const Matrix& A, const Matrix& C) {
  Pair out{A, C};
  if (moderate(A) && moderate(C)) return out;
  const Exponents found(A, C);
  for (Index j = 0; j < A.rows(); ++j) {
    for (Index i = 0; i < A.rows(); ++i) out.A(i, j) = std::ldexp(A(i, j), found.state(j) - found.state(i));
    for (Index k = 0; k < C.rows(); ++k) out.C(k, j) = std::ldexp(C(k, j), found.state(j) + found.output(k));
  }
  return out;
}

}  // namespace garrison::detail
