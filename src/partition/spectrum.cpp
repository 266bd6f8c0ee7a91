// SPDX-License-Identifier: Apache-2.0
#include "partition/spectrum.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/solvers.hpp"
#include "garrison/core/types.hpp"
#include "partition/exact_sum.hpp"
#include "partition/laplacian.hpp"

namespace garrison::partition {
namespace {

/// Residuals that settle: of lambda_2 in itself, as it may be far below lambda_max; of that in itself.
constexpr double kAccuracy2 = 1e-3;
constexpr double kAccuracyMax = 1e-6;
/// Square of what is left of a vector, below which the basis holds all there is.
constexpr double kNothing = 1e-24;

using Numbers = std::vector<double>;  // of own agents, by place

/// The symmetric tridiagonal matrix that Lanczos makes: diagonal alpha, beside it beta.
struct Tridiagonal {
  Numbers alpha, beta;

  Vector eigenvalues() const {
    const auto k = static_cast<Eigen::Index>(alpha.size());
    Eigen::SelfAdjointEigenSolver<Matrix> solver;
    solver.computeFromTridiagonal(Eigen::Map<const Vector>(alpha.data(), k),
                                  Eigen::Map<const Vector>(beta.data(), k - 1), Eigen::EigenvaluesOnly);
    return solver.eigenvalues();
  }
  /// Size of the last entry of the eigenvector of `value`, by inverse iteration.
  double last_entry(double value) const {
    const auto k = static_cast<Eigen::Index>(alpha.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < k; ++i) {
      entries.emplace_back(i, i, alpha[static_cast<std::size_t>(i)] - value * (1.0 + 1e-15));
      if (i + 1 == k) break;
      entries.emplace_back(i, i + 1, beta[static_cast<std::size_t>(i)]);
      entries.emplace_back(i + 1, i, beta[static_cast<std::size_t>(i)]);
    }
    Eigen::SparseMatrix<double> shifted(k, k);
    shifted.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(shifted);
    if (factor.info() != Eigen::Success) return 1.0;  // says nothing
    Vector x = Vector::Ones(k).normalized();
    for (int pass = 0; pass < 3; ++pass) x = factor.solve(x).normalized();
    return x.allFinite() ? std::abs(x(k - 1)) : 1.0;
  }
};

/// Vectors that are spread over ranks.
class Spread {
 public:
  Spread(const Region& region, Exchange& exchange) : region_(region), exchange_(exchange) {}

  double dot(const Numbers& a, const Numbers& b) const {
    ExactSum sum;
    for (std::size_t k = 0; k < a.size(); ++k) sum.add(a[k] * b[k]);
    return sum.total(exchange_);
  }
  /// Takes the mean of all agents off.
  void deflate(Numbers& v) const {
    ExactSum sum;
    for (const double one : v) sum.add(one);
    const double mean = sum.total(exchange_) / region_.agents;
    for (double& one : v) one -= mean;
  }
  Numbers start() const {
    Numbers v;
    for (int place = 0; place < region_.own; ++place)
      v.push_back(std::sin(1.0 + 12.9898 * region_.ids[static_cast<std::size_t>(place)]));
    deflate(v);
    const double length = std::sqrt(dot(v, v));
    for (double& one : v) one /= length;
    return v;
  }

 private:
  const Region& region_;
  Exchange& exchange_;
};

void look(const Tridiagonal& T, double next, double scale, Spectrum& s) {
  const Vector values = T.eigenvalues();
  const double low = values(0);
  const double high = values(values.size() - 1);
  s.lambda2 = scale * low;
  s.lambda_max = scale * high;
  s.residual2 = scale * next * T.last_entry(low);
  s.residual_max = scale * next * T.last_entry(high);
  s.settled = s.residual2 <= kAccuracy2 * s.lambda2 && s.residual_max <= kAccuracyMax * s.lambda_max;
}

}  // namespace

Spectrum laplacian_spectrum(const Region& region, Exchange& exchange, int most,
                            const std::function<void(const Spectrum&)>& looked) {
  const Spread spread(region, exchange);
  Laplacian laplacian(region, exchange);
  Spectrum s;
  s.bound = laplacian.bound();
  const double scale = s.bound;  // of L / scale no product is longer than its vector
  Tridiagonal T;
  Numbers q = spread.start();
  Numbers before(q.size(), 0.0);
  Numbers r(q.size());
  int next = 8;
  for (double beta = 0.0; s.products < most && !s.settled;) {
    laplacian.apply(q, r);
    ++s.products;
    for (std::size_t k = 0; k < r.size(); ++k) r[k] = r[k] / scale - beta * before[k];
    T.alpha.push_back(spread.dot(q, r));
    for (std::size_t k = 0; k < r.size(); ++k) r[k] -= T.alpha.back() * q[k];
    spread.deflate(r);
    const double square = spread.dot(r, r);
    const bool whole = square <= kNothing || s.products >= region.agents - 1;
    beta = whole ? 0.0 : std::sqrt(square);
    if (whole || s.products == most || s.products == next) {
      look(T, beta, scale, s);
      next += std::max(8, next / 4);
      if (looked) looked(s);
    }
    if (whole) break;
    T.beta.push_back(beta);
    std::swap(before, q);
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = r[k] / beta;
  }
  return s;
}

}  // namespace garrison::partition
