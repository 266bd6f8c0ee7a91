// SPDX-License-Identifier: Apache-2.0
#include "pencil.hpp"

#include <algorithm>
#include <numeric>

namespace garrison::detail {
namespace {

/// Eigenvalues closer than this part of the rate may be copies of one: eps^(1/12) is 0.05.
constexpr double kCluster = 0.05;
/// Share of the circle's radius below which a mode is far inside: nearer in small systems, where it costs
/// little.
double near_circle(Eigen::Index n) { return n <= kThorough ? 0.8 : 1.0 - 1e-6; }

/// Union-find over eigenvalues, with the sum of every set.
class Clusters {
 public:
  explicit Clusters(const Eigen::VectorXcd& values)
      : sum_(values), size_(static_cast<std::size_t>(values.size()), 1) {
    parent_.resize(size_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  /// Mean of both sets together; they are one from now on.
  Complex merge(std::size_t a, std::size_t b) {
    parent_[b] = a;
    size_[a] += size_[b];
    sum_(static_cast<Eigen::Index>(a)) += sum_(static_cast<Eigen::Index>(b));
    return sum_(static_cast<Eigen::Index>(a)) / static_cast<double>(size_[a]);
  }

 private:
  Eigen::VectorXcd sum_;
  std::vector<std::size_t> parent_;
  std::vector<int> size_;
};

struct Gap {
  double width;
  std::size_t a, b;
};

}  // namespace

Complex outside(Complex z, double least) {
  const double modulus = std::abs(z);
  if (modulus >= least) return z;
  if (z.imag() == 0.0) return z.real() < 0.0 ? -least : least;
  return z * (least / modulus);
}

std::vector<Complex> candidate_modes(const Matrix& A, const Matrix& balanced, double rate, double least) {
  const bool symmetric = (A.array() == A.transpose().array()).all();
  const Eigen::VectorXcd values =
      symmetric ? Eigen::VectorXcd(Eigen::SelfAdjointEigenSolver<Matrix>(A, Eigen::EigenvaluesOnly)
                                       .eigenvalues()
                                       .cast<Complex>())
                : Eigen::VectorXcd(Eigen::EigenSolver<Matrix>(balanced, false).eigenvalues());
  std::vector<Complex> all(values.begin(), values.end());
  const double same = 1e-15 * rate * static_cast<double>(A.rows());
  std::vector<Gap> gaps;
  for (Eigen::Index a = 0; a < values.size(); ++a)
    for (Eigen::Index b = a + 1; b < values.size(); ++b) {
      const double width = std::abs(values(a) - values(b));
      if (width < kCluster * rate)
        gaps.push_back({width, static_cast<std::size_t>(a), static_cast<std::size_t>(b)});
    }
  std::stable_sort(gaps.begin(), gaps.end(), [](const Gap& x, const Gap& y) { return x.width < y.width; });
  Clusters clusters(values);
  for (const Gap& gap : gaps) {
    const std::size_t a = clusters.root(gap.a);
    const std::size_t b = clusters.root(gap.b);
    if (a == b) continue;
    const Complex mean = clusters.merge(a, b);
    all.push_back(mean);
  }
  const auto largest = std::max_element(all.begin(), all.end(),
                                        [](Complex x, Complex y) { return std::abs(x) < std::abs(y); });
  const double from = std::min(near_circle(A.rows()) * least, std::abs(*largest));
  std::vector<Complex> kept;
  for (const Complex value : all) {
    if (std::abs(value) < from) continue;
    const Complex z = outside(value, least);
    const bool known =
        std::any_of(kept.begin(), kept.end(), [&](Complex k) { return std::abs(k - z) <= same; });
    if (!known) kept.push_back(z);
  }
  return kept;
}

}  // namespace garrison::detail
