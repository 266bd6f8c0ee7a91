// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/response.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "garrison/core/discretise.hpp"
#include "garrison/core/series.hpp"

using namespace garrison;

namespace {

Model driven_model() {
  return {Matrix{{0.9, 0.2}, {-0.1, 0.8}},
          {Matrix{{1.0, 0.0}}, Matrix{{0.0, 1.0}}},
          {},
          {},
          {},
          Matrix{{0.5}, {1.0}}};
}

}  // namespace

TEST_CASE("the response to inputs is the plant from zero") {
  const Model model = driven_model();
  Response response(model);
  Vector x = Vector::Zero(2);
  for (int t = 0; t < 20; ++t) {
    const Vector u{{std::sin(0.3 * t)}};
    response.advance(u);
    x = model.A() * x + model.B() * u;
    CHECK((response.state() - x).norm() <= 1e-14);
    CHECK(response.sample() == t + 1);
  }
}

TEST_CASE("inputs that are not known, do not fit or overflow are refused") {
  Response response(driven_model());
  CHECK_THROWS_WITH_AS(response.advance(Vector::Zero(2)), doctest::Contains("got 2 numbers, expected 1"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(response.advance(Vector{{kNaN}}), doctest::Contains("not finite at time 0"),
                       InvalidInput);
  Response growing(Model(Matrix{{1e100}}, {Matrix{{1.0}}}, {}, {}, {}, Matrix{{1.0}}));
  growing.advance(Vector{{1.0}});
  growing.advance(Vector{{1.0}});
  CHECK_THROWS_WITH_AS(growing.advance(Vector{{1.0}}), doctest::Contains("beyond 1e150"), InvalidInput);
}

TEST_CASE("a plant that was stacked by hand has the same bits") {
  test::Rng rng(4);
  for (int k = 0; k < 20; ++k) {
    const int n = 1 + k % 9;
    const int p = 1 + k % 3;
    const Matrix A = test::normal_matrix(rng, n, n);
    const Matrix B = test::normal_matrix(rng, n, p);
    const Vector x = test::normal_matrix(rng, n, 1);
    const Vector u = test::normal_matrix(rng, p, 1);
    Matrix stacked = Matrix::Zero(n + p, n + p);
    stacked << A, B, Matrix::Zero(p, n), Matrix::Identity(p, p);
    Vector both(n + p);
    both << x, u;
    const Vector next = stacked * both;
    CHECK(driven(A, x, B, u) == next.head(n));
  }
}

TEST_CASE("sizes that do not fit are refused") {
  CHECK_THROWS_WITH_AS(driven(Matrix::Identity(2, 2), Vector::Zero(3), Matrix::Ones(2, 1), Vector::Zero(1)),
                       doctest::Contains("B: got 2 x 1 for 3 states and 1 input"), InvalidInput);
}

TEST_CASE("an input that is held is the limit of many short steps") {
  const Matrix F{{0.0, 1.0}, {-2.0, -0.3}};
  const Matrix G{{0.0}, {1.5}};
  const Matrix once = held_input(F, G, 0.7);
  const Matrix A = discretise(F, Matrix::Zero(2, 2), 0.07).A;
  const Matrix step = held_input(F, G, 0.07);
  Matrix sum = Matrix::Zero(2, 1);
  for (int k = 0; k < 10; ++k) sum = A * sum + step;
  CHECK((once - sum).norm() <= 1e-14);
  CHECK(held_input(F, Matrix(2, 0), 0.7).cols() == 0);
  CHECK_THROWS_WITH_AS(held_input(F, Matrix::Ones(3, 1), 0.7), doctest::Contains("B: got 3 x 1"),
                       InvalidInput);
}

TEST_CASE("matrices over time are checked against the model") {
  const Model model = driven_model();
  const auto says = [&](const Series& series, const char* words) {
    CHECK_THROWS_WITH_AS(require_series(series, model, 2), doctest::Contains(words), InvalidInput);
  };
  const Matrix I = Matrix::Identity(2, 2);
  require_series({.A = {I, I}, .B = {model.B(), model.B()}, .C = {I, I}, .process_covariance = {I, I}}, model,
                 2);
  says({.A = {I}}, "A: got 1 matrix over time, expected at least 2");
  says({.A = {I, Matrix::Ones(2, 3)}}, "A[1]: got 2 x 3, expected 2 x 2");
  says({.B = {model.B(), I}}, "B[1]: got 2 x 2, expected 2 x 1");
  says({.C = {I, kNaN * I}}, "C[1]: got a number that is not finite");
  says({.process_covariance = {I, -I}}, "process_covariance[1]: got least eigenvalue -1");
  says({.process_covariance = {Matrix{{1.0, 1.0}, {0.0, 1.0}}, I}}, "not symmetric");
}
