// SPDX-License-Identifier: Apache-2.0
// Searches end when they are told to, with what they have proved so far.
#include "garrison/core/budget.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "garrison/analysis/subsets.hpp"
#include "garrison/engine/any_filter.hpp"

using namespace garrison;

namespace {

/// Says stop when it has been asked `questions` times.
std::function<bool()> after(int questions) {
  return [left = questions]() mutable { return left-- <= 0; };
}

Matrix unit_rows(test::Rng& rng, int N, int n) {
  Matrix C = test::normal_matrix(rng, N, n);
  C.rowwise().normalize();
  return C;
}

/// Least value over all choices of s rows.
double brute_force(const Matrix& C, int s) {
  std::vector<char> gone(static_cast<std::size_t>(C.rows()), 0);
  std::fill_n(gone.begin(), s, 1);
  double least = kInfinity;
  do {
    Matrix S = Matrix::Zero(C.cols(), C.cols());
    for (Eigen::Index i = 0; i < C.rows(); ++i)
      if (!gone[static_cast<std::size_t>(i)]) S += C.row(i).transpose() * C.row(i);
    least = std::min(least, Eigen::SelfAdjointEigenSolver<Matrix>(S).eigenvalues()(0));
  } while (std::prev_permutation(gone.begin(), gone.end()));
  return least;
}

}  // namespace

TEST_CASE("a budget is over when its time is up or somebody says stop, and stays over") {
  CHECK_FALSE(Budget().over());
  CHECK_FALSE(Budget(kInfinity).over());
  const Budget stopped(kInfinity, after(2));
  const Budget copy = stopped;
  CHECK_FALSE(stopped.over());
  CHECK_FALSE(copy.over());
  CHECK(stopped.over());
  CHECK(copy.over());
  CHECK(stopped.within(1e6).over());
  CHECK(stopped.within(1e6).within(1e5).over());
  const Budget tiny = Budget().within(0.0);
  while (!tiny.over()) {
  }
  CHECK(tiny.over());
  CHECK_THROWS_AS(Budget{0.0}, InvalidInput);
  CHECK_THROWS_AS(Budget{kNaN}, InvalidInput);
}

TEST_CASE("a scope sets the budget of this thread and gives the old one back") {
  CHECK_FALSE(current_budget().over());
  {
    const BudgetScope outer(Budget(kInfinity, after(0)));
    CHECK(current_budget().over());
    {
      const BudgetScope inner{Budget()};
      CHECK_FALSE(current_budget().over());
    }
    CHECK_THROWS_WITH_AS(require_time("a test"), doctest::Contains("used up in a test"), InvalidInput);
  }
  CHECK_FALSE(current_budget().over());
  require_time("nothing");
}

TEST_CASE("a search that is stopped returns an interval that contains the value") {
  test::Rng rng(1);
  for (int k = 0; k < 60; ++k) {
    const int n = test::whole(rng, 2, 4);
    const int N = test::whole(rng, n + 3, 12);
    const int s = test::whole(rng, 1, 3);
    const Matrix C = n == 2 ? unit_rows(rng, N, 3) : unit_rows(rng, N, n);
    const double exact = brute_force(C, s);
    const SubsetBound nodes = lambda0(C, s, {test::whole(rng, 1, 20)});
    const BudgetScope scope(Budget(kInfinity, after(test::whole(rng, 0, 3))));
    const SubsetBound stopped = lambda0(C, s);
    for (const SubsetBound* b : {&nodes, &stopped}) {
      CHECK(b->lower <= exact + 1e-12);
      CHECK(b->upper >= exact - 1e-12);
    }
  }
}

TEST_CASE(
    "fifty of a thousand sensors: check ends, exact for two states, with a certified lower bound for four") {
  test::Rng rng(2);
  const int N = 1000;
  for (const int n : {2, 4}) {
    const Matrix rows = unit_rows(rng, N, n);
    std::vector<Matrix> C;
    for (int i = 0; i < N; ++i) C.push_back(rows.row(i));
    Matrix A = Matrix::Identity(n, n);
    A(0, 1) = 0.01;
    const Model model(A, C, {0.01, Vector::Constant(N, 0.01), {}, {}});
    const auto filter = make_filter("saturation", {{"threshold", 1.0},
                                                   {"rounds", std::int64_t{40}},
                                                   {"attacked", std::int64_t{50}},
                                                   {"initial_error", 3.0},
                                                   {"detector", true}});
    const Check check = filter->check(model, Network::complete(N));
    bool found = false;
    for (const auto& q : check.quantities) {
      if (q.name != "lambda_0") continue;
      found = true;
      CHECK(q.value > 0.8 * (N / n - 50));
      CHECK(q.value < N / n);
      CHECK((q.meaning.find("certified lower bound") == 0) == (n == 4));
    }
    CHECK(found);
    // The interval is narrow, and every set of removed rows is above its lower end.
    const SubsetBound b = lambda0(rows, 50, usual_limits(N, n));
    CHECK(b.exact == (n == 2));
    CHECK(b.upper - b.lower < (n == 2 ? 1e-12 : 5e-2) * b.upper);
  }
}

TEST_CASE("many rows and large removals need no memory per removal, and equal rows are still one group") {
  test::Rng rng(3);
  Matrix C = unit_rows(rng, 20000, 3);
  for (int i = 0; i < 10000; ++i) C.row(2 * i + 1) = (i % 2 == 0 ? 1.0 : -1.0) * C.row(2 * i);
  const SubsetBound b = lambda0(C, 2000, usual_limits(20000, 3));
  CHECK(b.lower > 0.0);
  CHECK(b.lower <= b.upper);
  CHECK(lambda0_orthogonal(Matrix::Ones(5000, 1), 10) == 4990.0);
  CHECK(varpi_enumerated(C, Matrix::Identity(3, 3), 2000) == std::nullopt);
}
