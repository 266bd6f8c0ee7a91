// SPDX-License-Identifier: Apache-2.0
// A run that refutes an assumption says so, and publishes no proof.
#include <doctest/doctest.h>

#include "../../random_system.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;
using namespace garrison::test;

namespace {

Network complete(int agents) {
  std::vector<Edge> edges;
  for (int i = 0; i < agents; ++i)
    for (int j = i + 1; j < agents; ++j) edges.emplace_back(i, j);
  return {agents, edges};
}
/// Eight equal sensors of x+ = 0.9 x.
Model eight(double b_w, double b_v) {
  return {Matrix::Constant(1, 1, 0.9),
          std::vector<Matrix>(8, Matrix::Constant(1, 1, 1.0)),
          {b_w, Vector::Constant(8, b_v)}};
}
ParamMap detector(int attacked) {
  return {{"threshold", 0.5},
          {"rounds", std::int64_t{10}},
          {"attacked", std::int64_t{attacked}},
          {"initial_error", 2.0},
          {"detector", true}};
}

}  // namespace

TEST_CASE(
    "more sensors proved than can be attacked: nobody stays accused, and the run says what may be false") {
  // Told |v| <= 0.01 where it is up to 5: every sensor is "proved" attacked sooner or later.
  Rng rng(5);
  Matrix y(60, 8);
  for (Eigen::Index t = 0; t < y.rows(); ++t)
    for (Eigen::Index i = 0; i < y.cols(); ++i) y(t, i) = uniform(rng, -5.0, 5.0);
  const Record r =
      replay(eight(0.01, 0.01), complete(8), *make_filter("saturation", detector(1)), y, Matrix(), {});
  REQUIRE(r.warnings.size() == 1);
  CHECK(r.warnings[0].find("no accusation of this run is a proof") != std::string::npos);
  for (const std::string word : {"attacked", "measurement_bound", "process_bound", "initial_error"})
    CHECK(r.warnings[0].find(word) != std::string::npos);
  REQUIRE_FALSE(r.accusations.empty());
  for (const auto& set : r.accusations.back().sets) CHECK(set.empty());
  for (const auto& accusation : r.accusations)
    for (const auto& set : accusation.sets) CHECK(set.size() <= 1);
  for (std::size_t k = r.verdict.size() - 8; k < r.verdict.size(); ++k) {
    CHECK(r.verdict[k] != static_cast<std::uint8_t>(Verdict::attacked));
    CHECK(r.verdict[k] != static_cast<std::uint8_t>(Verdict::cleared));
    CHECK(std::isnan(r.bound[k]));
    CHECK(std::abs(r.estimate[k]) < 5.0);  // the saturation goes on
  }
}

TEST_CASE("a run whose assumptions hold keeps its proof and raises no doubt") {
  Rng rng(6);
  Matrix y(60, 8);
  for (Eigen::Index t = 0; t < y.rows(); ++t)
    for (Eigen::Index i = 0; i < y.cols(); ++i) y(t, i) = uniform(rng, -0.01, 0.01) + (i == 2 ? 50.0 : 0.0);
  const Record r =
      replay(eight(0.01, 0.01), complete(8), *make_filter("saturation", detector(1)), y, Matrix(), {});
  CHECK(r.warnings.empty());
  REQUIRE_FALSE(r.accusations.empty());
  for (const auto& set : r.accusations.back().sets) CHECK(set == std::vector<int>{2});
}

TEST_CASE("an adaptive threshold that grows without limit is a required condition that fails") {
  const auto adaptive = [](int attacked) {
    return make_filter("saturation", {{"adaptive", true},
                                      {"rounds", std::int64_t{10}},
                                      {"attacked", std::int64_t{attacked}},
                                      {"initial_error", 2.0}});
  };
  Matrix A(1, 1);
  A << 1.02;
  const Model model(A, std::vector<Matrix>(8, Matrix::Constant(1, 1, 1.0)),
                    {0.01, Vector::Constant(8, 0.01)});
  for (const int attacked : {1, 2, 3, 4, 5, 6}) {
    CAPTURE(attacked);
    const auto filter = adaptive(attacked);
    PlantOptions plant;
    plant.steps = 3000;
    const Record r = simulate(model, complete(8), *filter, plant, {});
    const bool settled = r.threshold.back() < 1.001 * r.threshold[r.threshold.size() / 2];
    CHECK(filter->check(model, complete(8)).holds() == settled);
    CHECK(settled == (attacked < 4));  // (11): lambda_0 = 8 - s > s
  }
}
