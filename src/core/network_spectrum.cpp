// SPDX-License-Identifier: Apache-2.0
// lambda_2 and lambda_max of the Laplacian: dense for small networks, Lanczos for large ones, with a
// factorisation where that stays sparse.
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <mutex>
#include <new>
#include <optional>
#include <vector>

#include "core/hops.hpp"
#include "core/lanczos.hpp"
#include "core/solvers.hpp"
#include "garrison/core/network.hpp"

namespace garrison {
namespace {

constexpr int kDenseLimit = 400;
constexpr int kLanczosSteps = 300;
constexpr double kLanczosAccuracy = 1e-13;
/// Of where to shift to: the error of a Ritz value is the square of its residual.
constexpr double kShiftAccuracy = 1e-4;
/// Of both ends at once, from products with the Laplacian itself.
constexpr double kPlainAccuracy = 1e-9;
/// lambda_2, in lambda_max, that a difference of such numbers gives without loss; and below which, in
/// networks that are small, factors stay sparse: a small lambda_2 means small separators.
constexpr double kClear = 1e-3;
constexpr double kSeparable = 1e-2;
constexpr int kSmall = 5000;  // agents

/// Factors may have more numbers than an int counts.
using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;

double largest_eigenvalue(Eigen::Index size, double accuracy,
                          const std::function<Vector(const Vector&)>& apply) {
  return detail::largest_eigenvalue(size, accuracy, kLanczosSteps, apply).value;
}

Sparse sparse_laplacian(const Network& network) {
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  for (int i = 0; i < network.agents(); ++i) {
    entries.emplace_back(i, i, network.degree(i));
    for (const int j : network.neighbours(i)) entries.emplace_back(i, j, -1.0);
  }
  Sparse lap(network.agents(), network.agents());
  lap.setFromTriplets(entries.begin(), entries.end());
  return lap;
}

/// Largest eigenvalue of a Laplacian. Where it lies close to the next ones, Lanczos on the matrix itself
/// stops short of it; on (sigma I - Lap)^-1 with sigma just above it, it stands out. A factorisation that
/// succeeds proves that sigma is above.
double top_eigenvalue(const Sparse& lap) {
  const double estimate =
      largest_eigenvalue(lap.rows(), kShiftAccuracy, [&](const Vector& v) { return Vector(lap * v); });
  Sparse identity(lap.rows(), lap.rows());
  identity.setIdentity();
  for (double sigma = estimate * (1.0 + 1e-4);; sigma += 0.01 * estimate) {
    const Eigen::SimplicialLDLT<Sparse> factor(Sparse(sigma * identity - lap));
    if (factor.info() != Eigen::Success || factor.vectorD().minCoeff() <= 0.0) continue;
    return sigma - 1.0 / largest_eigenvalue(lap.rows(), kLanczosAccuracy,
                                            [&](const Vector& v) { return Vector(factor.solve(v)); });
  }
}

/// Whether everybody is near everybody over many links: such networks fill a factor, and the ends of their
/// spectra stand out.
bool looks_well_connected(const Network& network) {
  const auto N = static_cast<std::size_t>(network.agents());
  if (network.lists().size() < 4 * N) return false;  // two entries for every link
  const detail::Hops hops = detail::hops_from(network, 0);
  return hops.reaches_all && hops.furthest <= 2.0 * std::log2(static_cast<double>(N));
}

/// Both ends by products alone; nothing where that takes too many.
std::optional<LaplacianSpectrum> by_products(const Sparse& lap) {
  // lambda_max lies between the largest degree plus one and twice the largest degree.
  const double degree = lap.diagonal().maxCoeff();
  const double shift = 2.0 * degree;
  const double least = (lap.rows() <= kSmall ? kSeparable : kClear) * (degree + 1.0);
  const auto low = detail::largest_eigenvalue(
      lap.rows(), kPlainAccuracy, kLanczosSteps, [&](const Vector& v) { return Vector(shift * v - lap * v); },
      shift - least);
  if (!low.settled) return {};
  const auto top = detail::largest_eigenvalue(lap.rows(), kPlainAccuracy, kLanczosSteps,
                                              [&](const Vector& v) { return Vector(lap * v); });
  if (!top.settled) return {};
  return LaplacianSpectrum{shift - low.value, top.value};
}

/// Both ends for many agents.
LaplacianSpectrum of_large(const Network& network) {
  const int agents = network.agents();
  const Sparse lap = sparse_laplacian(network);
  if (looks_well_connected(network))
    if (const auto both = by_products(lap)) return *both;
  const double lambda_max = top_eigenvalue(lap);
  if (!network.connected()) return {0.0, lambda_max};
  // lambda_2 = 1 / largest eigenvalue of the pseudo-inverse. Grounding agent 0 makes the Laplacian
  // definite; on vectors orthogonal to 1 its inverse differs from the pseudo-inverse by a constant only.
  const Sparse grounded = lap.bottomRightCorner(agents - 1, agents - 1);
  const Eigen::SimplicialLDLT<Sparse> factor(grounded);
  const double inverse = largest_eigenvalue(agents, kLanczosAccuracy, [&](const Vector& v) {
    Vector x = Vector::Zero(agents);
    x.tail(agents - 1) = factor.solve(v.tail(agents - 1));
    x.array() -= x.mean();
    return x;
  });
  return {1.0 / inverse, lambda_max};
}

/// The last large network and its spectrum: a check, a design and a run ask for the same one, and it takes
/// seconds. Threads: any.
class Last {
 public:
  LaplacianSpectrum of(const Network& network) {
    {
      const std::lock_guard lock(mutex_);
      if (std::ranges::equal(offsets_, network.offsets()) && std::ranges::equal(lists_, network.lists()))
        return spectrum_;
    }
    const LaplacianSpectrum found = of_large(network);
    remember(network, found);
    return found;
  }

 private:
  /// Not where that takes much memory, which stays taken, or more than there is.
  void remember(const Network& network, const LaplacianSpectrum& found) {
    constexpr std::size_t kMost = 50'000'000;
    if (network.lists().size() > kMost) return;
    try {
      std::vector<int> offsets(network.offsets().begin(), network.offsets().end());
      std::vector<int> lists(network.lists().begin(), network.lists().end());
      const std::lock_guard lock(mutex_);
      offsets_.swap(offsets);
      lists_.swap(lists);
      spectrum_ = found;
    } catch (const std::bad_alloc&) {
    }
  }

  std::mutex mutex_;
  std::vector<int> offsets_, lists_;
  LaplacianSpectrum spectrum_{};
};

}  // namespace

LaplacianSpectrum Network::laplacian_spectrum() const {
  if (directed_) refuse("network", "a directed one", "an undirected one", "its Laplacian must be symmetric");
  if (agents() == 1) return {0.0, 0.0};
  if (agents() <= kDenseLimit) {
    const Vector values =
        Eigen::SelfAdjointEigenSolver<Matrix>(laplacian(), Eigen::EigenvaluesOnly).eigenvalues();
    return {std::max(values(1), 0.0), values(agents() - 1)};
  }
  static Last last;
  return last.of(*this);
}

}  // namespace garrison
