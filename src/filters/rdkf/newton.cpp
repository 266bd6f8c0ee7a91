// SPDX-License-Identifier: Apache-2.0
#include "newton.hpp"

#include <cmath>
#include <utility>

#include "analysis/policy_iteration.hpp"
#include "core/solvers.hpp"
#include "sweeps.hpp"

namespace garrison::rdkf {
namespace {

using detail::Extended;
using detail::extended;
using detail::product;

/// (5) for Newton's method. The best policy at P weighs neighbour j by L_ij = P_i Pbar_j^-1 / d_i, P_i from
/// (5).
class Fusion : public detail::RiccatiMap {
 public:
  explicit Fusion(const Setting& s) : s_(s) {}

  detail::Matrices residual(const detail::Matrices& P) override {
    const Extended A = extended(s_.A);
    std::vector<Extended> information;
    for (std::size_t j = 0; j < P.size(); ++j) {
      const Extended prior = detail::congruence(A, extended(P[j])) + extended(s_.Sw[j]);
      const Extended R = detail::inverse_root(prior);
      information.push_back(product(R, R.transpose()));
    }
    weights_.assign(P.size(), {});
    detail::Matrices r;
    for (std::size_t i = 0; i < P.size(); ++i) {
      const auto& heard = s_.neighbours[i];
      Extended sum = Extended::Zero(s_.A.rows(), s_.A.cols());
      for (const int j : heard) sum += information[static_cast<std::size_t>(j)];
      sum /= static_cast<long double>(heard.size());
      const Extended next = updated(sum, s_.M[i]);
      r.push_back((next - extended(P[i])).cast<double>());
      const long double root = std::sqrt(static_cast<long double>(heard.size()));
      for (const int j : heard) {
        const Extended weight = product(product(next, information[static_cast<std::size_t>(j)]), A);
        weights_[i].push_back((weight / root).cast<double>());
      }
    }
    return r;
  }

  detail::Matrices apply(const detail::Matrices& D) const override {
    detail::Matrices all;
    for (std::size_t i = 0; i < D.size(); ++i) {
      Matrix sum = Matrix::Zero(s_.A.rows(), s_.A.cols());
      for (std::size_t k = 0; k < weights_[i].size(); ++k)
        sum += weights_[i][k] * D[static_cast<std::size_t>(s_.neighbours[i][k])] * weights_[i][k].transpose();
      all.push_back(std::move(sum));
    }
    return all;
  }

 private:
  const Setting& s_;
  std::vector<std::vector<Matrix>> weights_;  // sqrt(d_i) L_ij A, in the order of N_i
};

/// What n samples of all sensors tell of the state, without process noise.
Matrix information(const Matrix& A, const std::vector<Matrix>& seen) {
  Matrix all = Matrix::Zero(A.rows(), A.cols());
  for (const Matrix& one : seen) all += one;
  Matrix O = all;
  for (Eigen::Index k = 1; k < A.rows(); ++k) O = all + A.transpose() * O * A;
  return O;
}

/// Units of the states, powers of 2, in which they are seen about equally well; 1 for states nobody sees.
Vector units(const Setting& s) {
  return information(s.A, measured(s)).diagonal().unaryExpr([](double seen) {
    return seen > 0.0 ? std::exp2(-std::round(0.5 * std::log2(seen))) : 1.0;
  });
}

/// The same problem for the states x / unit.
Setting in_units(const Setting& s, const Vector& unit) {
  const Vector back = unit.cwiseInverse();
  Setting own = s;
  own.A = back.asDiagonal() * s.A * unit.asDiagonal();
  for (Matrix& C : own.C) C = C * unit.asDiagonal();
  for (Matrix& M : own.M) M = M * unit.asDiagonal();
  for (Matrix& Sw : own.Sw) Sw = back.asDiagonal() * Sw * back.asDiagonal();
  return own;
}

/// Process noise that excites every seen mode about as strongly as it is seen, and none less than Sw does:
/// with it no mode is slow to settle. `s`: in `units`.
Matrix even_noise(const Setting& s, const std::vector<Matrix>& seen) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(information(s.A, seen));
  constexpr double kLeast = 1e-12;  // times the largest; below it rounding decides
  const double least = kLeast * eigen.eigenvalues().maxCoeff();
  const Vector inverse = eigen.eigenvalues().unaryExpr([&](double v) { return 1.0 / std::max(v, least); });
  const Matrix shape = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  double most = 1.0;
  for (const Matrix& Sw : s.Sw)
    most = std::max(most, Sw.diagonal().cwiseQuotient(shape.diagonal()).maxCoeff());
  return most * shape;
}

std::vector<Matrix> noisier(const Setting& s, double more, const Matrix& even) {
  std::vector<Matrix> all;
  for (const Matrix& Sw : s.Sw) all.push_back(Sw + more * (Sw + even));
  return all;
}

/// Times `even` at which every state has about the noise of Sw alone.
double own_noise(const Setting& s, const Matrix& even) {
  double least = 1.0;
  for (const Matrix& Sw : s.Sw)
    least = std::min(least, Sw.diagonal().cwiseQuotient(even.diagonal()).minCoeff());
  return least;
}

}  // namespace

bool newton(const Setting& given, SteadyState& out) {
  constexpr double kFall = 1e-4;
  const Vector unit = units(given);
  const Setting s = in_units(given, unit);
  const std::vector<Matrix> seen = measured(s);
  const Matrix even = even_noise(s, seen);
  const double own = own_noise(s, even);
  Setting noisy = s;
  SteadyState rough;
  double more = 1.0;
  for (bool settled = false; !settled; out.sweeps += rough.sweeps) {
    more *= 1e2;
    if (more > 1e20) return false;
    rough = {};
    rough.P.assign(s.C.size(), Matrix::Zero(s.A.rows(), s.A.cols()));
    noisy.Sw = noisier(s, more, even);
    settled = settle(noisy, seen, 1e-6, kQuickSweeps, rough);
  }
  std::vector<Matrix> P = std::move(rough.P);
  while (more > 0.0) {
    more = more > own ? more * kFall : 0.0;
    noisy.Sw = noisier(s, more, even);
    for (Matrix& one : P) one *= 1.01;
    Fusion fusion(noisy);
    auto found = detail::policy_iteration(fusion, std::move(P));
    out.sweeps += found.steps;
    if (!found.converged) return false;
    P = std::move(found.P);
    out.change = found.change;
  }
  for (std::size_t i = 0; i < P.size(); ++i) out.P[i] = unit.asDiagonal() * P[i] * unit.asDiagonal();
  return true;
}

bool finish(const Setting& given, SteadyState& out) {
  Vector largest = Vector::Zero(given.A.rows());
  for (const Matrix& P : out.P) largest = largest.cwiseMax(P.diagonal());
  if (!(largest.minCoeff() > 0.0)) return false;
  const Vector unit =
      largest.unaryExpr([](double variance) { return std::exp2(std::round(0.5 * std::log2(variance))); });
  const Setting s = in_units(given, unit);
  const Vector back = unit.cwiseInverse();
  std::vector<Matrix> P;
  for (const Matrix& one : out.P) P.push_back(1.01 * (back.asDiagonal() * one * back.asDiagonal()));
  Fusion fusion(s);
  const auto found = detail::policy_iteration(fusion, std::move(P));
  out.sweeps += found.steps;
  if (!found.converged) return false;
  for (const Matrix& one : found.P)
    if (Eigen::LLT<Matrix>(one).info() != Eigen::Success) return false;
  for (std::size_t i = 0; i < found.P.size(); ++i)
    out.P[i] = unit.asDiagonal() * found.P[i] * unit.asDiagonal();
  out.change = found.change;
  return true;
}

}  // namespace garrison::rdkf
