// SPDX-License-Identifier: Apache-2.0
#include "balance.hpp"

#include <algorithm>
#include <cmath>

namespace garrison::detail {
namespace {

using Index = Eigen::Index;

/// Powers of 2 beyond which nobody's units lie; products of two of them are still numbers.
constexpr double kMostPower = 200.0;
constexpr int kMostSweeps = 60;
/// A scaling that moves by less than this factor is settled: only its power of 2 is used.
constexpr double kSettled = 0.02;

double square(double x) { return x * x; }

double power_of_2(double d) {
  return std::exp2(std::round(std::clamp(std::log2(d), -kMostPower, kMostPower)));
}

class Balancing {
 public:
  Balancing(const Matrix& A, const Matrix& C, double rate, double pull)
      : A_(A.cwiseAbs2()), C_(C.cwiseAbs2()), target_(C.rows() > 0 ? square(rate * pull) : 0.0) {
    A_.diagonal().setZero();
    d_ = Vector::Ones(A.rows());
    s_ = Vector::Ones(C.rows());
    order_ = from_outputs(A, C);
    for (Index j = 0; order_.size() < static_cast<std::size_t>(A.rows()); ++j)
      if (std::find(order_.begin(), order_.end(), j) == order_.end()) order_.push_back(j);
  }

  void run() {
    first_pass();
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      double moved = 0.0;
      for (const Index j : order_) moved = std::max(moved, state(j));
      for (Index k = 0; k < s_.size(); ++k) moved = std::max(moved, output(k));
      if (moved < kSettled) return;
    }
  }
  const Vector& d() const { return d_; }
  const Vector& s() const { return s_; }

 private:
  /// Scales every output by its own row, then every state by what is nearer to the outputs.
  void first_pass() {
    if (C_.rows() == 0) return;
    for (Index k = 0; k < s_.size(); ++k) output(k);
    std::vector<char> done(static_cast<std::size_t>(d_.size()), 0);
    for (const Index j : order_) {
      double mass = C_.col(j).dot(s_.cwiseAbs2());
      for (Index i = 0; i < d_.size(); ++i)
        if (done[static_cast<std::size_t>(i)]) mass += A_(i, j) / square(d_(i));
      if (mass > 0.0) d_(j) = std::sqrt(target_ / mass);
      done[static_cast<std::size_t>(j)] = 1;
    }
  }

  /// The best scale of one state, all others as they are; returns |log| of the change.
  double state(Index j) {
    const double p = (A_.col(j).array() / d_.array().square()).sum() +
                     (C_.rows() > 0 ? C_.col(j).dot(s_.cwiseAbs2()) : 0.0);
    const double r = A_.row(j).dot(d_.cwiseAbs2());
    if (!(p > 0.0) || (target_ == 0.0 && !(r > 0.0))) return 0.0;
    return set(d_(j), std::sqrt((target_ + std::sqrt(target_ * target_ + 4.0 * p * r)) / (2.0 * p)));
  }

  double output(Index k) {
    const double row = C_.row(k).dot(d_.cwiseAbs2());
    if (!(row > 0.0)) return 0.0;
    const double share = target_ * static_cast<double>(d_.size()) / static_cast<double>(s_.size());
    return set(s_(k), std::sqrt(share / row));
  }

  static double set(double& scale, double value) {
    const double bounded = std::clamp(value, std::exp2(-kMostPower), std::exp2(kMostPower));
    const double moved = std::abs(std::log(bounded / scale));
    scale = bounded;
    return moved;
  }

  Matrix A_, C_;  // squares of the entries, without the diagonal of A
  double target_;
  Vector d_, s_;
  std::vector<Index> order_;
};

}  // namespace

std::vector<Index> from_outputs(const Matrix& A, const Matrix& C) {
  const Index n = A.rows();
  std::vector<Index> order;
  std::vector<char> known(static_cast<std::size_t>(n), 0);
  const auto add = [&](Index j) {
    if (known[static_cast<std::size_t>(j)]) return;
    known[static_cast<std::size_t>(j)] = 1;
    order.push_back(j);
  };
  for (Index j = 0; j < n; ++j)
    if (C.rows() > 0 && (C.col(j).array() != 0.0).any()) add(j);
  for (std::size_t k = 0; k < order.size(); ++k)
    for (Index j = 0; j < n; ++j)
      if (A(order[k], j) != 0.0) add(j);
  return order;
}

Pair balanced(const Matrix& A, const Matrix& C, double rate, double pull) {
  Balancing balancing(A, C, rate, pull);
  balancing.run();
  const Vector d = balancing.d().unaryExpr(&power_of_2);
  const Vector s = balancing.s().unaryExpr(&power_of_2);
  Pair out;
  out.A = d.cwiseInverse().asDiagonal() * A * d.asDiagonal();
  out.C = s.asDiagonal() * C * d.asDiagonal();
  return out;
}

Pair rows_scaled(const Matrix& A, const Matrix& C, double rate) {
  Pair out{A, C};
  for (Index k = 0; k < C.rows(); ++k) {
    const double length = C.row(k).stableNorm();
    if (length > 0.0) out.C.row(k) *= power_of_2(rate / length);
  }
  return out;
}

double natural_rate(const Matrix& A) {
  const double largest =
      A.cwiseAbs().cwiseSqrt().cwiseProduct(A.transpose().cwiseAbs().cwiseSqrt()).maxCoeff();
  return largest > 0.0 ? largest : 1.0;
}

std::vector<char> reach_outputs(const Matrix& A, const Matrix& C) {
  std::vector<char> reached(static_cast<std::size_t>(A.rows()), 0);
  for (const Index j : from_outputs(A, C)) reached[static_cast<std::size_t>(j)] = 1;
  return reached;
}

}  // namespace garrison::detail
