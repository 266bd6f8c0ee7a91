// SPDX-License-Identifier: Apache-2.0
// Default poles of lfre follow the noise, and check prints what they do to it.
#include "garrison/filters/lfre.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include "../random_system.hpp"
#include "garrison/analysis/lyapunov.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/any_filter.hpp"

using namespace garrison;

namespace {

Model vehicle(double T, double process, double measurement) {
  const Matrix row{{1.0, 0.0}};
  return {Matrix{{1.0, T}, {0.0, 1.0}},
          {row, row, row},
          {kNaN, {}, process * Matrix::Identity(2, 2), std::vector<Matrix>(3, Matrix{{measurement}})}};
}

double mean_square(const Model& model, const Matrix& H) {
  const Matrix F =
      model.noise().process_covariance + H * model.noise().measurement_covariance[0] * H.transpose();
  return lyapunov(model.A() - H * model.C(0), F).trace();
}

}  // namespace

TEST_CASE("with little process noise the default poles are slow, and far quieter than 0.3 and 0.4") {
  const Model model = vehicle(0.01, 1e-8, 1.0);
  const auto chosen = Lfre::design({}, model, Network::complete(3));
  Lfre::Params fast;
  fast.poles = {0.3, 0.4};
  const auto before = Lfre::design(fast, model, Network::complete(3));
  CHECK(mean_square(model, chosen.observer[0]) * 100.0 < mean_square(model, before.observer[0]));
}

TEST_CASE("no default poles are better than the ones chosen, in random plants") {
  test::Rng rng(1);
  for (int k = 0; k < 50; ++k) {
    const Model model =
        vehicle(std::pow(10.0, test::uniform(rng, -2, 0)), std::pow(10.0, test::uniform(rng, -6, 1)),
                std::pow(10.0, test::uniform(rng, -2, 1)));
    const double chosen = mean_square(model, Lfre::design({}, model, Network::complete(3)).observer[0]);
    for (const double first : {0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
      Lfre::Params params;
      params.poles = {first, first + 0.1};
      CHECK(chosen <=
            mean_square(model, Lfre::design(params, model, Network::complete(3)).observer[0]) * (1.0 + 1e-9));
    }
  }
}

TEST_CASE("check prints the noise gain") {
  // One state, pole p: H = a - p, gain sqrt(H^2 / (1 - p^2)).
  const Model model(Matrix{{0.9}}, std::vector<Matrix>(3, Matrix{{1.0}}));
  const auto quantity = [&](double pole, const char* name) {
    for (const auto& q : make_filter("lfre", {{"poles", std::vector<double>{pole}}})
                             ->check(model, Network::complete(3))
                             .quantities)
      if (q.name == name) return q.value;
    return -1.0;
  };
  CHECK(quantity(0.5, "noise gain") == doctest::Approx(0.4 / std::sqrt(0.75)).epsilon(1e-12));
  CHECK(quantity(0.5, "slowest pole") == doctest::Approx(0.5));
  for (const double pole : {1.0, -1.0}) CHECK_THROWS_AS(quantity(pole, "noise gain"), InvalidInput);
}

TEST_CASE("a source uses all of its outputs, and is never worse than with one of them") {
  test::Rng rng(2);
  for (int k = 0; k < 30; ++k) {
    const int n = 2 + k % 3;
    const Matrix A = test::normal_matrix(rng, n, n) / std::sqrt(n);
    const Matrix C = test::normal_matrix(rng, 2, n);
    const Matrix R = Vector{{std::pow(10.0, test::uniform(rng, -2, 2)), 1.0}}.asDiagonal();
    const Matrix Q = 0.1 * Matrix::Identity(n, n);
    const Model both(A, {C}, {kNaN, {}, Q, {R}});
    const Matrix H = Lfre::design({}, both, Network::complete(1)).observer[0];
    for (int r = 0; r < 2; ++r) {
      const Model one(A, {C.row(r)}, {kNaN, {}, Q, {R.block(r, r, 1, 1)}});
      const Matrix alone = Lfre::design({}, one, Network::complete(1)).observer[0];
      CHECK(mean_square(both, H) <= mean_square(one, alone) * (1.0 + 1e-9));
    }
  }
}

TEST_CASE("outputs that see the state together make a source; what each one misses does not matter") {
  const Model model(Matrix::Identity(2, 2), std::vector<Matrix>(3, Matrix::Identity(2, 2)),
                    {kNaN, {}, 0.1 * Matrix::Identity(2, 2), std::vector<Matrix>(3, Matrix::Identity(2, 2))});
  Lfre::Params params;
  params.poles = {0.5, 0.25};
  const auto gains = Lfre::design(params, model, Network::complete(3));
  REQUIRE(gains.observer[1].cols() == 2);
  const Vector found =
      Eigen::EigenSolver<Matrix>(Matrix::Identity(2, 2) - gains.observer[1], false).eigenvalues().real();
  CHECK(found.minCoeff() == doctest::Approx(0.25).epsilon(1e-12));
  CHECK(found.maxCoeff() == doctest::Approx(0.5).epsilon(1e-12));
  // Two sensors of one number, variances 1 and 4: weights 4/5 and 1/5, as in their weighted mean.
  const Model scalar(Matrix{{1.0}}, {Matrix{{1.0}, {1.0}}},
                     {kNaN, {}, Matrix{{0.1}}, {Matrix{{1.0, 0.0}, {0.0, 4.0}}}});
  params.poles = {0.5};
  const Matrix H = Lfre::design(params, scalar, Network::complete(1)).observer[0];
  CHECK(H(0, 0) == doctest::Approx(0.4).epsilon(1e-12));
  CHECK(H(0, 1) == doctest::Approx(0.1).epsilon(1e-12));
}

TEST_CASE("an output that is missing corrects nothing, the others do") {
  const Model model(Matrix{{1.0}}, {Matrix{{1.0}, {1.0}}},
                    {kNaN, {}, Matrix{{0.1}}, {Matrix{{1.0, 0.0}, {0.0, 4.0}}}});
  RunOptions options;
  const Matrix y{{5.0, 10.0}, {kNaN, 10.0}, {kNaN, kNaN}, {0.0, 0.0}};
  const Record run =
      replay(model, Network::complete(1), *make_filter("lfre", {{"poles", std::vector<double>{0.5}}}), y,
             Matrix(), options);
  // 0, then 0 (nothing measured before), 0.4 * 5 + 0.1 * 10 = 3, 3 + 0.1 * 7, the same
  const std::vector<double> expected{0.0, 0.0, 3.0, 3.7, 3.7};
  for (std::size_t t = 0; t < expected.size(); ++t)
    CHECK(run.estimate[t] == doctest::Approx(expected[t]).epsilon(1e-12));
}
