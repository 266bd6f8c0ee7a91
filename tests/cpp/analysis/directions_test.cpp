// SPDX-License-Identifier: Apache-2.0
// lambda_0 by directions: against all sets where there are few, against the search over sets where there are
// many.
#include "analysis/directions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include "../random_system.hpp"
#include "analysis/branch_and_bound.hpp"
#include "analysis/copositive.hpp"
#include "core/solvers.hpp"

using namespace garrison;

namespace {

double least_eigenvalue(const Matrix& S) {
  return std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix>(S).eigenvalues()(0));
}

/// Sum of the outer products of all rows but those removed.
Matrix sum_without(const Matrix& C, const std::vector<int>& removed) {
  Matrix S = Matrix::Zero(C.cols(), C.cols());
  for (int i = 0; i < static_cast<int>(C.rows()); ++i)
    if (!std::binary_search(removed.begin(), removed.end(), i)) S += C.row(i).transpose() * C.row(i);
  return S;
}

double brute_force(const Matrix& C, int s) {
  double least = kInfinity;
  for (unsigned mask = 0; mask < (1U << C.rows()); ++mask) {
    if (__builtin_popcount(mask) != s) continue;
    std::vector<int> removed;
    for (int i = 0; i < static_cast<int>(C.rows()); ++i)
      if ((mask >> i & 1U) != 0) removed.push_back(i);
    least = std::min(least, least_eigenvalue(sum_without(C, removed)));
  }
  return least;
}

Matrix random_rows(test::Rng& rng, int N, int n) {
  Matrix C = test::normal_matrix(rng, N, n);
  const int kind = test::whole(rng, 0, 6);
  if (kind == 1 || kind == 3) C.rowwise().normalize();
  if (kind == 2) C = C.unaryExpr([](double v) { return std::round(v); });
  if (kind == 3)
    for (int i = 1; i < N; i += 2) C.row(i) = -C.row(i - 1);
  if (kind == 4) C.row(0).setZero();
  if (kind == 5)
    for (int i = 0; i < N; ++i) C.row(i) *= std::pow(10.0, test::whole(rng, -6, 6));
  if (kind == 6)
    for (int i = 1; i < N; ++i) C.row(i) = C.row(0) + 1e-5 * C.row(i);
  return C;
}

}  // namespace

TEST_CASE("the interval of a search by directions contains what all sets give") {
  test::Rng rng(23);
  int exact = 0;
  for (int instance = 0; instance < 1000; ++instance) {
    const int n = test::whole(rng, 1, 3);
    const int N = test::whole(rng, n, 12);
    const int s = test::whole(rng, 0, std::min(N - n, 5));
    const Matrix C = random_rows(rng, N, n);
    const double truth = brute_force(C, s);
    const auto found = detail::lambda0_by_directions(C, s, {20000, kInfinity});
    const double rounding = 2e-14 * C.squaredNorm();
    CAPTURE(instance);
    CHECK(found.lower <= truth + rounding);
    CHECK(found.upper >= truth - rounding);
    CHECK(std::abs(least_eigenvalue(sum_without(C, found.removed)) - found.upper) <= rounding);
    CHECK(static_cast<int>(found.removed.size()) == s);
    if (n < 3) CHECK(found.exact);
    if (found.exact) CHECK(found.upper - found.lower <= rounding);
    exact += found.exact ? 1 : 0;
  }
  CHECK(exact > 950);
}

TEST_CASE("thousands of rows, any share removed: the search over sets does not disagree") {
  test::Rng rng(24);
  for (int instance = 0; instance < 30; ++instance) {
    const int N = test::whole(rng, 1000, 3000);
    const int s = instance % 3 == 0 ? test::whole(rng, 1, 5) : N * test::whole(rng, 1, 30) / 100;
    Matrix C = test::normal_matrix(rng, N, 2);
    if (instance % 2 == 0) C.rowwise().normalize();
    if (instance % 5 == 0) C.col(0) *= 0.1;
    const auto found = detail::lambda0_by_directions(C, s, {});
    const auto sets = detail::BranchAndBound<2>(C, s, {100, kInfinity}).run();
    CAPTURE(instance);
    CHECK(found.exact);
    CHECK(found.lower <= sets.upper);
    CHECK(found.upper >= sets.lower);
    CHECK(std::abs(least_eigenvalue(sum_without(C, found.removed)) - found.upper) <= 1e-12 * C.squaredNorm());
  }
}

TEST_CASE("the unit of the rows does not matter, however large or small") {
  test::Rng rng(26);
  for (int instance = 0; instance < 300; ++instance) {
    const int n = test::whole(rng, 1, 4);
    const int N = test::whole(rng, 15, n < 4 ? 39 : 18);
    const int s = test::whole(rng, 1, 5);
    const Matrix C = random_rows(rng, N, n);
    const SubsetLimits limits{20000, kInfinity};
    const auto found = lambda0(C, s, limits);
    for (const int power : {-199, 199, 450}) {
      const auto other = lambda0(C * std::ldexp(1.0, power), s, limits);
      CAPTURE(instance);
      CAPTURE(power);
      const double rounding = 1e-13 * C.squaredNorm();
      CHECK(std::ldexp(other.lower, -2 * power) ==
            doctest::Approx(found.lower).epsilon(1e-9).scale(rounding / 1e-9));
      CHECK(std::ldexp(other.upper, -2 * power) ==
            doctest::Approx(found.upper).epsilon(1e-9).scale(rounding / 1e-9));
    }
  }
}

TEST_CASE("directions that are all equally weak, and a search that is stopped") {
  constexpr int N = 1000;
  Matrix C(N, 2);
  for (int i = 0; i < N; ++i)
    C.row(i) << std::cos(std::numbers::pi * i / N), std::sin(std::numbers::pi * i / N);
  const auto found = detail::lambda0_by_directions(C, 50, {});
  CHECK(found.exact);
  // The removed rows are the 50 around the weakest direction: a sum of cosines.
  const double removed = 25.0 + 0.5 * std::sin(50 * std::numbers::pi / N) / std::sin(std::numbers::pi / N);
  CHECK(found.lower == doctest::Approx(N / 2.0 - removed).epsilon(1e-12));
  double width = kInfinity;
  for (const std::int64_t nodes : {1, 10, 100, 1000}) {
    const auto stopped = detail::lambda0_by_directions(C, 50, {nodes, kInfinity});
    CHECK(stopped.lower <= found.upper);
    CHECK(stopped.upper >= found.lower);
    CHECK(stopped.upper - stopped.lower <= width);
    width = stopped.upper - stopped.lower;
  }
  CHECK(detail::lambda0_by_directions(C, 50, {1, kInfinity}).lower > 0.8 * found.lower);
}

TEST_CASE("copositive matrices: no vector without negative entries disagrees") {
  test::Rng rng(25);
  int yes = 0;
  for (int instance = 0; instance < 2000; ++instance) {
    const int n = test::whole(rng, 1, 3);
    Matrix R = test::normal_matrix(rng, n, n);
    R = (R + R.transpose() + 2.0 * Matrix::Identity(n, n)).eval();
    double least = kInfinity;
    constexpr int kSteps = 60;
    for (int a = 0; a <= kSteps; ++a)
      for (int b = 0; b <= kSteps - a; ++b) {
        const Vector t = Vector{{double(a), double(b), double(kSteps - a - b)}}.head(n) / kSteps;
        least = std::min(least, t.dot(R * t));
      }
    const bool said = detail::copositive(R);
    yes += said ? 1 : 0;
    if (said) CHECK(least >= -1e-12);
    if (!said) CHECK(least < 1e-2);  // the grid misses the least value by little
  }
  CHECK(yes > 200);
  CHECK(yes < 1800);
}
