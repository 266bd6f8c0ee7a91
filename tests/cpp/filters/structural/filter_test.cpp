// SPDX-License-Identifier: Apache-2.0
// The filter itself: tests, memory of the verdict, missing numbers, bad input.
#include <doctest/doctest.h>

#include "garrison/attacks/measurement.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/structural/detection.hpp"
#include "random_setting.hpp"

using namespace garrison;

namespace {

Model model_of(test::Rng& rng, int n, int agents, double norm) {
  const Model bare = test::scalar_model(rng, n, agents, norm, 0.02, 0.01);
  Noise noise;
  noise.process_covariance = 0.01 * Matrix::Identity(n, n);
  noise.measurement_covariance.assign(static_cast<std::size_t>(agents), Matrix::Constant(1, 1, 0.04));
  std::vector<Matrix> C;
  for (int i = 0; i < agents; ++i) C.push_back(bare.C(i));
  return {bare.A(), C, noise};
}

Record run(const Model& model, const Network& network, const ParamMap& params, int steps,
           std::vector<Attack> attacks = {}, int trials = 1) {
  RunOptions o;
  o.trials = trials;
  o.seed = 7;
  o.attacks = std::move(attacks);
  o.keep.signals = true;
  return simulate(model, network, *make_filter("structural", params), {steps, {}, 0.0, "normal"}, o);
}

/// Share of samples from `from` on at which the statistic is not below its threshold.
double alarm_rate(const Record& r, int from) {
  double alarms = 0.0;
  double all = 0.0;
  for (std::size_t k = 0; k < r.statistic.size(); ++k) {
    const auto time = static_cast<int>(k / static_cast<std::size_t>(r.agents)) % (r.steps + 1);
    if (time < from || std::isnan(r.threshold[k])) continue;
    all += 1.0;
    alarms += r.statistic[k] >= r.threshold[k] ? 1.0 : 0.0;
  }
  REQUIRE(all > 1000.0);
  return alarms / all;
}

}  // namespace

TEST_CASE("alarms without an attack are as frequent as asked for, per sample and per window") {
  test::Rng rng(51);
  for (const int n : {1, 3, 9}) {
    const Model model = model_of(rng, n, 4, 0.95);
    const Network network = Network::ring(4);
    for (const ParamMap& params : {ParamMap{{"false_alarm", 0.05}},
                                   ParamMap{{"false_alarm", 0.05}, {"test", std::string("innovation")}},
                                   ParamMap{{"false_alarm", 0.05}, {"window", std::int64_t{5}}},
                                   ParamMap{{"false_alarm", 0.05}, {"share", std::string("none")}}}) {
      CAPTURE(n);
      CHECK(alarm_rate(run(model, network, params, 400, {}, 40), 1) == doctest::Approx(0.05).epsilon(0.12));
    }
  }
}

TEST_CASE("a biased sensor accuses itself, and hysteresis keeps the verdict") {
  test::Rng rng(52);
  const Model model = model_of(rng, 2, 4, 0.9);
  const Record r =
      run(model, Network::complete(4), {{"false_alarm", 1e-6}, {"clear_after", std::int64_t{10}}}, 200,
          {bias(Schedule(50, {2}, 100), 5.0)});
  REQUIRE_FALSE(r.accusations.empty());
  for (const auto& a : r.accusations)
    for (std::size_t i = 0; i < 4; ++i)
      for (const int who : a.sets[i]) CHECK(who == static_cast<int>(i));  // the test is local
  const auto verdict = [&](int t) { return r.verdict[static_cast<std::size_t>(t * 4 + 2)]; };
  CHECK(verdict(49) == static_cast<std::uint8_t>(Verdict::cleared));
  CHECK(verdict(51) == static_cast<std::uint8_t>(Verdict::attacked));
  CHECK(verdict(104) == static_cast<std::uint8_t>(Verdict::attacked));
  CHECK(verdict(150) == static_cast<std::uint8_t>(Verdict::cleared));
}

TEST_CASE("an isolated sensor no longer moves the estimates") {
  test::Rng rng(53);
  const Model model = model_of(rng, 2, 5, 0.9);
  const std::vector<Attack> attack{bias(Schedule(50, {1}), 20.0)};
  const auto worst = [&](bool isolate) {
    const Record r =
        run(model, Network::complete(5), {{"isolate", isolate}, {"false_alarm", 0.001}}, 200, attack);
    return *std::max_element(r.error.begin() + 100 * 5, r.error.end());
  };
  CHECK(worst(true) < 1.5);
  CHECK(worst(false) > 2.0 * worst(true));
}

TEST_CASE(
    "no verdict at the start; after a loss the level is that of a bound until all is stationary again") {
  test::Rng rng(54);
  const Model model = model_of(rng, 2, 3, 0.9);
  const auto filter = make_filter("structural", {{"settle", std::int64_t{40}}});
  RunOptions o;
  o.start = Matrix::Constant(2, 1, 100.0);
  Matrix y = Matrix::Zero(400, 3);
  y(60, 1) = kNaN;
  const Record r = replay(model, Network::path(3), *filter, y, Matrix(), o);
  const auto level = [&](int t, int i) { return r.threshold[static_cast<std::size_t>(3 * t + i)]; };
  for (int t = 1; t <= 40; ++t) CHECK(std::isnan(level(t, 0)));
  for (int i = 0; i < 3; ++i) CHECK(level(41, i) > 0.0);
  // Row 60 is time 61. Agents 0 and 2 hear agent 1: all three miss y_1.
  CHECK(std::isnan(level(61, 1)));
  for (const int i : {0, 2}) CHECK(level(61, i) > level(60, i));
  for (int i = 0; i < 3; ++i) {
    CHECK(level(62, i) > level(60, i));
    CHECK(level(400, i) == level(60, i));
  }
}

TEST_CASE("relays, one agent, directed and unconnected networks run") {
  test::Rng rng(55);
  const Noise noise{
      kNaN, {}, Matrix::Identity(2, 2), {Matrix::Identity(1, 1), Matrix(0, 0), Matrix::Identity(1, 1)}};
  const Model model(0.9 * Matrix::Identity(2, 2), {Matrix::Identity(1, 2), Matrix(0, 2), Matrix::Ones(1, 2)},
                    noise);
  for (const Network& network : {Network(3, std::vector<Edge>{{0, 1}, {2, 1}}, true), Network::path(3),
                                 Network(3, std::vector<Edge>{})}) {
    const auto filter = make_filter("structural", {});
    const Record r = replay(model, network, *filter, Matrix::Zero(20, 2), Matrix(), {});
    CHECK(r.verdict[3 * 20 + 1] == static_cast<std::uint8_t>(Verdict::silent));
    CHECK(filter->check(model, network).conditions.size() > 3);
  }
  const Model one(Matrix::Constant(1, 1, 1.2), {Matrix::Ones(1, 1)},
                  {kNaN, {}, Matrix::Identity(1, 1), {Matrix::Identity(1, 1)}});
  const Record r = replay(one, Network(1, std::vector<Edge>{}), *make_filter("structural", {}),
                          Matrix::Zero(1, 1), Matrix(), {});
  CHECK(std::isfinite(r.estimate.back()));
}

TEST_CASE("the structural filter refuses with which, got, expected") {
  test::Rng rng(56);
  const Model model = model_of(rng, 2, 3, 0.9);
  const Network path = Network::path(3);
  const auto prepare = [&](const ParamMap& params, const Model& m) {
    make_filter("structural", params)->prepare(m, path);
  };
  CHECK_THROWS_WITH_AS(prepare({{"weights", std::vector<double>(4, 0.5)}}, model),
                       doctest::Contains("structural.weights: got 4 numbers, expected 9"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare({{"weights", std::vector<double>(9, 1.0 / 3.0)}}, model),
                       doctest::Contains("agent 0 does not hear agent 2"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare({{"weights", std::vector<double>{1, 0, 0, 0, 0.5, 0, 0, 0, 1}}}, model),
                       doctest::Contains("row 1 of W: got a sum of 0.5"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare({{"gain", std::vector<double>(3, 1.0)}}, model),
                       doctest::Contains("structural.gain: got 3 numbers, expected 12"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare({{"false_alarm", 0.0}}, model), doctest::Contains("false_alarm"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(prepare({{"false_alarm", 1.0}}, model), doctest::Contains("false_alarm"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(prepare({{"window", std::int64_t{0}}}, model), doctest::Contains("window"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(prepare({}, Model(model.A(), std::vector<Matrix>(3, Matrix::Ones(1, 2)))),
                       doctest::Contains("process_covariance"), InvalidInput);
  const Model blind(2.0 * Matrix::Identity(2, 2), std::vector<Matrix>(3, Matrix::Identity(1, 2)),
                    {kNaN, {}, Matrix::Identity(2, 2), std::vector<Matrix>(3, Matrix::Identity(1, 1))});
  CHECK_THROWS_WITH_AS(prepare({}, blind), doctest::Contains("not detectable (no output shows the mode 2)"),
                       InvalidInput);
  const Model two(model.A(), {Matrix::Ones(2, 2), Matrix::Ones(1, 2), Matrix::Ones(1, 2)});
  CHECK_THROWS_WITH_AS(prepare({}, two), doctest::Contains("split_outputs"), InvalidInput);
}
