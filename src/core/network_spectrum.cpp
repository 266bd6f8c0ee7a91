// SPDX-License-Identifier: Apache-2.0
// lambda_2 and lambda_max of the Laplacian: dense for small networks, Lanczos for large ones.
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "core/solvers.hpp"
#include "garrison/core/network.hpp"

namespace garrison {
namespace {

constexpr int kDenseLimit = 400;
constexpr int kLanczosSteps = 300;
constexpr double kLanczosAccuracy = 1e-13;
/// Of where to shift to: the error of a Ritz value is the square of its residual.
constexpr double kShiftAccuracy = 1e-4;

using Sparse = Eigen::SparseMatrix<double>;

/// Estimate of the largest eigenvalue of a symmetric operator on the space orthogonal to the all-ones vector,
/// by Lanczos with full reorthogonalisation; stops when the residual of the Ritz vector is `accuracy` of it.
double largest_eigenvalue(Eigen::Index size, double accuracy,
                          const std::function<Vector(const Vector&)>& apply) {
  const auto deflate = [](Vector& v) { v.array() -= v.mean(); };
  Vector q(size);
  for (Eigen::Index i = 0; i < size; ++i) q(i) = std::sin(1.0 + 12.9898 * static_cast<double>(i));
  deflate(q);
  q.normalize();
  const int most = static_cast<int>(std::min<Eigen::Index>(kLanczosSteps, size - 1));
  Matrix basis(size, most);
  Vector alpha = Vector::Zero(most);
  Vector beta = Vector::Zero(most);
  double value = 0.0;
  for (int k = 0; k < most; ++k) {
    basis.col(k) = q;
    Vector r = apply(q);
    alpha(k) = q.dot(r);
    deflate(r);
    for (int pass = 0; pass < 2; ++pass) r -= basis.leftCols(k + 1) * (basis.leftCols(k + 1).transpose() * r);
    beta(k) = r.norm();
    if (k % 8 == 7 || k + 1 == most || beta(k) < 1e-300) {
      Eigen::SelfAdjointEigenSolver<Matrix> ritz;
      ritz.computeFromTridiagonal(alpha.head(k + 1), beta.head(k), Eigen::ComputeEigenvectors);
      value = ritz.eigenvalues()(k);
      if (beta(k) * std::abs(ritz.eigenvectors()(k, k)) <= accuracy * std::abs(value)) break;
    }
    q = r / beta(k);
  }
  return value;
}

Sparse sparse_laplacian(const Network& network) {
  std::vector<Eigen::Triplet<double>> entries;
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

}  // namespace

LaplacianSpectrum Network::laplacian_spectrum() const {
  if (directed_) refuse("network", "a directed one", "an undirected one", "its Laplacian must be symmetric");
  if (agents() == 1) return {0.0, 0.0};
  if (agents() <= kDenseLimit) {
    const Vector values =
        Eigen::SelfAdjointEigenSolver<Matrix>(laplacian(), Eigen::EigenvaluesOnly).eigenvalues();
    return {std::max(values(1), 0.0), values(agents() - 1)};
  }
  const Sparse lap = sparse_laplacian(*this);
  const double lambda_max = top_eigenvalue(lap);
  if (!connected()) return {0.0, lambda_max};
  // lambda_2 = 1 / largest eigenvalue of the pseudo-inverse. Grounding agent 0 makes the Laplacian
  // definite; on vectors orthogonal to 1 its inverse differs from the pseudo-inverse by a constant only.
  const Sparse grounded = lap.bottomRightCorner(agents() - 1, agents() - 1);
  const Eigen::SimplicialLDLT<Sparse> factor(grounded);
  const double inverse = largest_eigenvalue(agents(), kLanczosAccuracy, [&](const Vector& v) {
    Vector x = Vector::Zero(agents());
    x.tail(agents() - 1) = factor.solve(v.tail(agents() - 1));
    x.array() -= x.mean();
    return x;
  });
  return {1.0 / inverse, lambda_max};
}

}  // namespace garrison
