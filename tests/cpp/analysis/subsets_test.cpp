// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/subsets.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "core/solvers.hpp"
#include "garrison/analysis/observability.hpp"

using namespace garrison;

namespace {

/// Calls visit(kept rows) for every choice of s removed rows.
template <class Visit>
void each_choice(const Matrix& C, int s, const Visit& visit) {
  const auto N = static_cast<int>(C.rows());
  for (unsigned mask = 0; mask < (1U << N); ++mask) {
    if (__builtin_popcount(mask) != N - s) continue;
    Matrix kept(N - s, C.cols());
    for (int i = 0, k = 0; i < N; ++i)
      if (mask >> i & 1U) kept.row(k++) = C.row(i);
    visit(kept);
  }
}

double least_eigenvalue(const Matrix& kept) {
  const Matrix S = kept.transpose() * kept;
  return std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix>(S).eigenvalues()(0));
}

double norm(const Matrix& m) { return Eigen::JacobiSVD<Matrix>(m).singularValues()(0); }

Matrix random_rows(test::Rng& rng, int N, int n) {
  Matrix C = test::normal_matrix(rng, N, n);
  const int kind = test::whole(rng, 0, 4);
  if (kind == 1 || kind == 3) C.rowwise().normalize();
  if (kind == 2) C = C.unaryExpr([](double v) { return std::round(v); });
  if (kind == 3)
    for (int i = 1; i < N; i += 2) C.row(i) = -C.row(i - 1);
  if (kind == 4) C.row(0).setZero();
  return C;
}

}  // namespace

TEST_CASE("lambda_0, varpi and tau_0 equal enumeration, and the safe end is safe") {
  test::Rng rng(2024);
  for (int instance = 0; instance < 700; ++instance) {
    const int n = test::whole(rng, 1, 5);
    const int N = test::whole(rng, 1, 11);
    const int s = test::whole(rng, 0, std::min(N, 4));
    const Matrix C = random_rows(rng, N, n);
    const Matrix A = test::normal_matrix(rng, n, n);
    double least = kInfinity;
    double most = 0.0;
    double tau = 0.0;
    each_choice(C, s, [&](const Matrix& kept) {
      least = std::min(least, kept.rows() == 0 ? 0.0 : least_eigenvalue(kept));
      const Matrix S = kept.transpose() * kept;
      most = std::max(most, norm((Matrix::Identity(n, n) - S / N) * A));
      Matrix blocks = Matrix::Zero(n, kept.rows() * n);
      for (Eigen::Index i = 0; i < kept.rows(); ++i)
        blocks.middleCols(i * n, n) = kept.row(i).transpose() * kept.row(i) * A;
      if (kept.rows() > 0) tau = std::max(tau, norm(blocks) / N);
    });
    CAPTURE(instance);
    CAPTURE(N);
    CAPTURE(n);
    CAPTURE(s);
    const double scale = 1.0 + C.squaredNorm();
    const auto found = lambda0(C, s);
    CAPTURE(found.method);
    CHECK(found.exact);
    CHECK(found.lower == doctest::Approx(least).epsilon(1e-9).scale(1e-3 * scale));
    CHECK(found.lower <= least + 1e-14 * scale);
    CHECK(static_cast<int>(found.removed.size()) == s);
    CHECK(varpi(C, A, s).upper == doctest::Approx(most).epsilon(1e-10));
    CHECK(tau0(C, A, s).upper == doctest::Approx(tau).epsilon(1e-10));
  }
}

TEST_CASE("a search that is stopped still gives a certified lower bound") {
  test::Rng rng(7);
  for (int instance = 0; instance < 40; ++instance) {
    Matrix C = test::normal_matrix(rng, 24, 4);
    if (instance % 2 == 0) C.rowwise().normalize();
    const double truth = lambda0(C, 5).lower;
    const auto stopped = lambda0(C, 5, {2 + instance, kInfinity});
    CHECK(stopped.lower <= truth * (1 + 1e-12));
    CHECK(stopped.upper >= truth * (1 - 1e-12));
    if (!stopped.exact) CHECK(stopped.lower < stopped.upper);
  }
}

TEST_CASE("1.7e13 subsets") {
  test::Rng rng(1);
  Matrix C = test::normal_matrix(rng, 100, 4);
  CHECK(lambda0(C, 10).exact);
  C.rowwise().normalize();
  CHECK(lambda0(C, 10).exact);
}

TEST_CASE("subset functions refuse what makes no sense") {
  const Matrix C = Matrix::Ones(3, 2);
  CHECK_THROWS_WITH_AS(lambda0(C, 4), doctest::Contains("lambda0.s: got 4, expected a number in 0..3"),
                       InvalidInput);
  CHECK_THROWS_AS(lambda0(C, -1), InvalidInput);
  CHECK_THROWS_AS(lambda0(C * kNaN, 1), InvalidInput);
  CHECK_THROWS_AS(varpi(C, Matrix::Zero(3, 3), 1), InvalidInput);
  CHECK(lambda0(C, 3).lower == 0.0);
}

TEST_CASE("sparse observability against enumeration") {
  test::Rng rng(5);
  for (int instance = 0; instance < 200; ++instance) {
    const int n = test::whole(rng, 1, 3);
    const int N = test::whole(rng, 2, 8);
    const int s = test::whole(rng, 0, N);
    Matrix C = random_rows(rng, N, n);
    Matrix A = test::normal_matrix(rng, n, n);
    if (instance % 3 == 0) A = Matrix::Identity(n, n);
    bool all = true;
    each_choice(C, s, [&](const Matrix& kept) { all = all && observable(A, kept); });
    CHECK(s_sparse_observable(A, C, s) == all);
  }
}
