// SPDX-License-Identifier: Apache-2.0
// Poles of observers are where they were asked to be.
#include "garrison/analysis/poles.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "../random_system.hpp"

using namespace garrison;

namespace {

/// Largest distance of a sorted eigenvalue of A - H C from its pole.
double miss(const Matrix& A, const Matrix& C, const std::vector<double>& poles) {
  const Eigen::VectorXcd found =
      Eigen::EigenSolver<Matrix>(A - place_poles(A, C, poles) * C, false).eigenvalues();
  std::vector<double> real(static_cast<std::size_t>(found.size()));
  for (Eigen::Index k = 0; k < found.size(); ++k) real[static_cast<std::size_t>(k)] = found(k).real();
  std::vector<double> sorted = poles;
  std::sort(real.begin(), real.end());
  std::sort(sorted.begin(), sorted.end());
  double most = found.imag().cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < real.size(); ++k) most = std::max(most, std::abs(real[k] - sorted[k]));
  return most;
}

}  // namespace

TEST_CASE("random plants with several outputs get the poles that were asked for") {
  test::Rng rng(1);
  for (int k = 0; k < 200; ++k) {
    const int n = test::whole(rng, 1, 6);
    const Matrix A = test::normal_matrix(rng, n, n);
    const Matrix C = test::normal_matrix(rng, test::whole(rng, 2, 3), n);
    std::vector<double> poles;
    for (int i = 0; i < n; ++i) poles.push_back(-0.5 + 0.2 * i);
    CHECK(miss(A, C, poles) < 1e-8);
  }
}

TEST_CASE("plants that no single combination of outputs observes") {
  const Matrix I = Matrix::Identity(3, 3);
  CHECK(miss(I, I, {0.1, 0.2, 0.3}) < 1e-12);
  CHECK(miss(I, I, {0.2, 0.2, 0.3}) < 1e-12);  // twice: there are three outputs
  CHECK(miss(I, Matrix{{1, 0, 0}, {0, 1, 1}, {0, 0, 1}}, {1.0, 0.5, 0.0}) <
        1e-12);  // a pole of the plant's own
  const Matrix twice{
      {1, 0.1, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0.1}, {0, 0, 0, 1}};  // double integrators in a plane
  CHECK(miss(twice, Matrix{{1, 0, 0, 0}, {0, 0, 1, 0}}, {0.5, 0.5, 0.6, 0.6}) < 1e-7);
}

TEST_CASE("what cannot be had is refused by name") {
  const Matrix I = Matrix::Identity(2, 2);
  CHECK_THROWS_WITH_AS(place_poles(I, I.row(0).replicate(2, 1), {0.5, 0.5}),
                       doctest::Contains("at most 1 times"), InvalidInput);
  CHECK_THROWS_WITH_AS(place_poles(I, I, {0.5}), doctest::Contains("one per state"), InvalidInput);
  CHECK_THROWS_AS(place_poles(I, Matrix(0, 2), {0.5, 0.4}), InvalidInput);
  CHECK_THROWS_AS(place_poles(Matrix(2, 3), I, {0.5, 0.4}), InvalidInput);
}
