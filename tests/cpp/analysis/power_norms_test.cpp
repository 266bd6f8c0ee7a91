// SPDX-License-Identifier: Apache-2.0
// Errors in gaps: ||A^k|| instead of ||A||^k, and never below the truth.
#include "garrison/analysis/power_norms.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "garrison/filters/platoon/setting.hpp"

using namespace garrison;

TEST_CASE("a vehicle without GPS and radar: the bound grows like a polynomial") {
  const double T = 0.1;
  const PowerNorms norms(Matrix{{1.0, T}, {0.0, 1.0}}, 64);
  for (int k = 0; k <= 64; ++k)  // A^k is a vehicle's A with the period k T
    CHECK(norms.norm(k) == doctest::Approx(platoon::norm_A(k * T)).epsilon(1e-12));
  const double start = 5.0;
  CHECK(norms.predicted(64, start, 0.0) < 40.0);
  CHECK(std::pow(platoon::norm_A(T), 600) * start > 1e12);
  const PowerNorms minute(Matrix{{1.0, T}, {0.0, 1.0}}, 600);
  CHECK(minute.predicted(600, start, 0.0) < 310.0);
  CHECK(minute.predicted(600, start, 0.0) >= start * 60.0);  // a speed error of `start` moves that far
}

TEST_CASE("no trajectory leaves the bound, within the table and beyond it") {
  test::Rng rng(1);
  for (int run = 0; run < 200; ++run) {
    const int n = test::whole(rng, 1, 4);
    Matrix A = test::normal_matrix(rng, n, n);
    A *= test::uniform(rng, 0.3, 1.05) /
         Eigen::EigenSolver<Matrix>(A, false).eigenvalues().cwiseAbs().maxCoeff();
    const PowerNorms norms(A, test::whole(rng, 1, 12));
    const double start = test::uniform(rng, 0, 2);
    const double step = test::uniform(rng, 0, 0.5);
    Vector e = start * test::normal_matrix(rng, n, 1).col(0).normalized();
    const double a = Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
    for (int k = 1; k <= 30; ++k) {
      e = A * e + step * test::normal_matrix(rng, n, 1).col(0).normalized();
      CHECK(e.norm() <= norms.predicted(k, start, step) * (1.0 + 1e-12));
      CHECK(norms.norm(k) <= std::pow(a, k) * (1.0 + 1e-9) + 1e-300);
    }
  }
  CHECK(PowerNorms(Matrix{{2.0}}, 3).predicted(0, 1.5, 7.0) == 1.5);
}

TEST_CASE("power norms refuse what makes no sense") {
  CHECK_THROWS_AS(PowerNorms(Matrix(2, 3), 4), InvalidInput);
  CHECK_THROWS_AS(PowerNorms(Matrix{{kNaN}}, 4), InvalidInput);
  CHECK_THROWS_AS(PowerNorms(Matrix{{1.0}}, 0), InvalidInput);
}
