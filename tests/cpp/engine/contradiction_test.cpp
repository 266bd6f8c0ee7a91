// SPDX-License-Identifier: Apache-2.0
// Records that refute the bounds of the noise are found, and no others.
#include "garrison/drivers/contradiction.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "garrison/core/budget.hpp"

using namespace garrison;

namespace {

struct Case {
  Model model;
  Matrix y;
};

/// Noise on its bounds, `share` of which the model tells; `liars` sensors off by anything, the same ones for
/// good or others each time.
Case recorded(test::Rng& rng, int n, int agents, int liars, bool for_good, double share_w, double share_v) {
  const Model true_one = test::scalar_model(rng, n, agents, test::uniform(rng, 0.8, 1.0), 0.2, 0.02);
  const Matrix C = true_one.stacked();
  Noise noise = true_one.noise();
  noise.process_bound *= share_w;
  noise.measurement_bound *= share_v;
  std::vector<Matrix> rows;
  for (int i = 0; i < agents; ++i) rows.push_back(true_one.C(i));
  Case out{Model(true_one.A(), rows, noise), Matrix(60, agents)};
  Vector x = test::normal_matrix(rng, n, 1);
  std::vector<int> order(static_cast<std::size_t>(agents));
  for (int i = 0; i < agents; ++i) order[static_cast<std::size_t>(i)] = i;
  for (Eigen::Index t = 0; t < out.y.rows(); ++t) {
    const Vector w = test::normal_matrix(rng, n, 1);
    x = true_one.A() * x + 0.2 * (1.0 - 1e-12) * w / w.norm();
    out.y.row(t) = (C * x).transpose();
    for (int i = 0; i < agents; ++i) out.y(t, i) += test::whole(rng, 0, 1) == 0 ? -0.02 : 0.02;
    if (!for_good || t == 0) std::shuffle(order.begin(), order.end(), rng);
    for (int k = 0; k < liars; ++k)
      out.y(t, order[static_cast<std::size_t>(k)]) += std::pow(10.0, test::uniform(rng, -2.0, 8.0));
  }
  return out;
}

Refuted verdict(const Case& c, int attacked, bool for_good) {
  return contradictions(c.model, c.y, 1, {.attacked = attacked, .for_good = for_good})[0].refuted;
}

}  // namespace

TEST_CASE("bounds that hold are never refuted, whoever lies") {
  test::Rng rng(1);
  for (int k = 0; k < 60; ++k) {
    const int n = test::whole(rng, 1, 3);
    const int agents = test::whole(rng, n, 9);
    const int liars = test::whole(rng, 0, std::min(2, agents));
    const bool for_good = k % 2 == 0;
    CAPTURE(k);
    CHECK(verdict(recorded(rng, n, agents, liars, for_good, 1.0, 1.0), liars, for_good) == Refuted::nothing);
  }
}

TEST_CASE("bounds a quarter too small are refuted, each by its name") {
  test::Rng rng(2);
  for (const bool for_good : {false, true})
    for (int k = 0; k < 10; ++k) {
      CAPTURE(k);
      CHECK(verdict(recorded(rng, 2, 7, 1, for_good, 0.75, 1.0), 1, for_good) == Refuted::process_bound);
      CHECK(verdict(recorded(rng, 2, 9, 1, for_good, 1.0, 0.75), 1, for_good) == Refuted::measurement_bound);
    }
}

TEST_CASE("measurements that nobody reaches do not lie") {
  const Matrix I = Matrix::Identity(1, 1);
  const Noise noise{.process_bound = 1.0, .measurement_bound = Vector::Constant(2, 0.1)};
  const Matrix y{{0.0, 5.0}, {0.0, 5.0}};
  CHECK(contradictions(Model(I, {I, I}, noise), y, 1, {.attacked = 1})[0].refuted == Refuted::nothing);
  const Model secured(I, {I, I}, noise, {0, 0});
  CHECK(contradictions(secured, y, 1, {.attacked = 1})[0].refuted == Refuted::measurement_bound);
  CHECK(contradictions(secured, y, 1, {.attacked = 1})[0].row == 0);
}

TEST_CASE("the search keeps to its budget and refuses what does not fit") {
  test::Rng rng(3);
  const Case c = recorded(rng, 2, 7, 0, false, 0.75, 1.0);
  {
    const Budget over(1.0, [] { return true; });
    const BudgetScope scope(over);
    CHECK(verdict(c, 0, false) == Refuted::nothing);
  }
  CHECK_THROWS_AS(contradictions(c.model, c.y.leftCols(3), 1, {}), InvalidInput);
  CHECK_THROWS_AS(contradictions(c.model, c.y, 1, {.owner = {0}}), InvalidInput);
  CHECK_THROWS_AS(contradictions(c.model, c.y, 1, {.attacked = -1}), InvalidInput);
  CHECK_THROWS_AS(contradictions(c.model, c.y, 1, {.inputs = Matrix::Zero(59, 1)}), InvalidInput);
}

TEST_CASE("every trial is looked at, and by what it says itself") {
  test::Rng rng(5);
  for (const int trials : {2, 30, 300}) {
    const Case honest = recorded(rng, 2, 9, 1, false, 1.0, 1.0);
    Matrix all = honest.y.replicate(trials, 1);
    const std::vector<int> wrong{trials / 2, trials - 1};
    for (const int k : wrong)
      for (int t = 0; t < 60; ++t)
        for (int i = 0; i < 9; ++i) all(60 * k + t, i) += test::whole(rng, 0, 1) == 0 ? -0.06 : 0.06;
    const auto found = contradictions(honest.model, all, trials, {.attacked = 1});
    REQUIRE(found.size() == static_cast<std::size_t>(trials));
    for (int k = 0; k < trials; ++k) {
      CAPTURE(k);
      const bool named = std::find(wrong.begin(), wrong.end(), k) != wrong.end();
      CHECK((found[static_cast<std::size_t>(k)].refuted != Refuted::nothing) == named);
    }
  }
  const Case c = recorded(rng, 2, 7, 0, false, 1.0, 1.0);
  CHECK_THROWS_AS(contradictions(c.model, c.y, 7, {}), InvalidInput);
  CHECK_THROWS_AS(contradictions(c.model, c.y, 0, {}), InvalidInput);
}
