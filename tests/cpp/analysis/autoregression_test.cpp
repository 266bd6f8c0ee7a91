// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/autoregression.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"

using namespace garrison;

namespace {

const Matrix A1{{0.5, 0.2}, {-0.1, 0.3}};
const Matrix A2{{0.3, 0.0}, {0.1, 0.4}};
const Matrix B{{1.0}, {-2.0}};

/// Records of a plant that looks two samples back and is driven.
std::pair<Matrix, Matrix> records(int T, double noise) {
  test::Rng rng(11);
  const Matrix e = noise * test::normal_matrix(rng, T, 2);
  const Matrix u = test::normal_matrix(rng, T, 1);
  Matrix z = Matrix::Zero(T, 2);
  for (int t = 2; t < T; ++t)
    z.row(t) = (A1 * z.row(t - 1).transpose() + A2 * z.row(t - 2).transpose() + B * u.row(t).transpose() +
                e.row(t).transpose())
                   .transpose();
  return {z, u};
}

}  // namespace

TEST_CASE("records without noise give the plant back exactly") {
  const auto [z, u] = records(200, 0.0);
  const Autoregression found = autoregress(z, u, {.order = 2});
  CHECK((found.A.topLeftCorner(2, 2) - A1).norm() <= 1e-10);
  CHECK((found.A.topRightCorner(2, 2) - A2).norm() <= 1e-10);
  CHECK(found.A.bottomLeftCorner(2, 2) == Matrix::Identity(2, 2));
  CHECK(found.A.bottomRightCorner(2, 2) == Matrix::Zero(2, 2));
  CHECK((found.B.topRows(2) - B).norm() <= 1e-10);
  CHECK(found.B.bottomRows(2) == Matrix::Zero(2, 1));
  CHECK(found.residual_bound <= 1e-9);
}

TEST_CASE("held-out samples choose the order that the records have") {
  const auto [z, u] = records(3000, 0.3);
  const Autoregression found = autoregress(z, u, {});
  CHECK(found.order == 2);
  REQUIRE(found.held_out.size() == 4);
  CHECK(found.held_out[1] > found.held_out[0] + 0.01);
  CHECK((found.A.topLeftCorner(2, 2) - A1).norm() < 0.1);
  CHECK((found.residual_covariance - 0.09 * Matrix::Identity(2, 2)).norm() < 0.02);
  CHECK(std::isnan(found.residuals(1, 0)));
  CHECK(found.residuals.row(2).allFinite());
  CHECK(found.samples == 2998);
}

TEST_CASE("samples with a gap in their past are left out") {
  auto [z, u] = records(300, 0.0);
  z(100, 1) = kNaN;
  u(150, 0) = kNaN;
  const Autoregression found = autoregress(z, u, {.order = 2});
  CHECK(found.samples == 298 - 3 - 1);
  CHECK((found.A.topLeftCorner(2, 2) - A1).norm() <= 1e-10);
}

TEST_CASE("what cannot be fitted is refused") {
  const auto [z, u] = records(100, 0.3);
  const auto says = [&](const Matrix& rows, const Matrix& inputs, const AutoregressionOptions& o,
                        const char* words) {
    CHECK_THROWS_WITH_AS(autoregress(rows, inputs, o), doctest::Contains(words), InvalidInput);
  };
  says(z, u, {.order = 5}, "fit.order: got 5, expected a number in 1..4");
  says(z, u, {.most = 0}, "fit.most: got 0");
  says(z, u, {.held_out = 1.0}, "fit.held_out: got 1");
  says(z, u.topRows(3), {}, "fit.inputs: got 3 rows, expected 100");
  says(z.topRows(30), u.topRows(30), {.order = 2}, "28 samples with a complete past, expected at least 50");
  Matrix twice(100, 2);
  twice << z.col(0), z.col(0);
  says(twice, u, {.order = 1}, "depend on each other");
  Matrix season;
  CHECK_THROWS_WITH_AS(identified(autoregress(z, u, {.order = 1}), season, {}, 1.0),
                       doctest::Contains("fit.noise"), InvalidInput);
  CHECK_THROWS_WITH_AS(identified(autoregress(z, u, {.order = 1}), Matrix::Zero(1, 3), {}, 0.1),
                       doctest::Contains("season: got 1 x 3, expected a column per station"), InvalidInput);
  says(Matrix(100, 0), u, {}, "records: got 100 x 0");
}
