// SPDX-License-Identifier: Apache-2.0
// Default poles of lfre follow the noise, and check prints what they do to it.
#include "garrison/filters/lfre.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "garrison/analysis/lyapunov.hpp"
#include "garrison/engine/any_filter.hpp"

using namespace garrison;

namespace {

Model vehicle(double T, double process, double measurement) {
  const Matrix row{{1.0, 0.0}};
  return {Matrix{{1.0, T}, {0.0, 1.0}},
          {row, row, row},
          {kNaN, {}, process * Matrix::Identity(2, 2), std::vector<Matrix>(3, Matrix{{measurement}})}};
}

double mean_square(const Model& model, const Vector& H) {
  const Matrix F =
      model.noise().process_covariance + model.noise().measurement_covariance[0](0, 0) * H * H.transpose();
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
  CHECK(std::isnan(quantity(1.0, "noise gain")));
}
