// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "../../random_system.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

const std::vector<Matrix> kRows{Matrix::Ones(1, 1), Matrix::Ones(1, 1), Matrix::Ones(1, 1)};
const Noise kNoise{0.01, Vector::Constant(3, 0.01), {}, {}};
const Model kModel(Matrix::Constant(1, 1, 0.9), kRows, kNoise);
const ParamMap kBounded{
    {"threshold", 1.0}, {"rounds", std::int64_t{5}}, {"attacked", std::int64_t{1}}, {"initial_error", 1.0}};

void prepare(const ParamMap& params, const Model& model = kModel, const Network& network = Network::path(3)) {
  make_filter("saturation", params)->prepare(model, network);
}

ParamMap with(ParamMap params, const std::string& name, ParamValue value) {
  params[name] = std::move(value);
  return params;
}

}  // namespace

TEST_CASE("the saturation filter refuses with which, got, expected") {
  const std::vector<Edge> one_edge{{0, 1}};
  CHECK_THROWS_WITH_AS(prepare(kBounded, kModel, Network(3, one_edge)), doctest::Contains("not connected"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(prepare(kBounded, kModel, Network(3, std::vector<Edge>{{0, 1}, {1, 2}}, true)),
                       doctest::Contains("directed"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare(kBounded, kModel, Network::path(4)), doctest::Contains("4 agents"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(prepare({}), doctest::Contains("saturation.threshold: got no value"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare(with(kBounded, "threshold", 0.0)),
                       doctest::Contains("got 0, expected a number > 0"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare(with(kBounded, "attacked", std::int64_t{4})),
                       doctest::Contains("at most the number of agents, 3"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare(with(kBounded, "step", 5.0)), doctest::Contains("diverge"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare(with({{"threshold", 1.0}}, "detector", true)),
                       doctest::Contains("initial_error"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare(with({{"threshold", 1.0}}, "accuse_missing", true)),
                       doctest::Contains("false without detector"), InvalidInput);
  CHECK_THROWS_WITH_AS(prepare(kBounded, Model(kModel.A(), kRows)), doctest::Contains("process_bound"),
                       InvalidInput);
  std::vector<Matrix> longer = kRows;
  longer[1] *= 1.7;
  CHECK_THROWS_WITH_AS(prepare(kBounded, Model(kModel.A(), longer, kNoise)),
                       doctest::Contains("C[1]: got a row of length 1.7, expected a row of unit length"),
                       InvalidInput);
  std::vector<Matrix> two = kRows;
  two[2] = Matrix::Ones(2, 1);
  CHECK_THROWS_WITH_AS(prepare(kBounded, Model(kModel.A(), two, kNoise)), doctest::Contains("split_outputs"),
                       InvalidInput);
  const Model unstable(Matrix::Constant(1, 1, 3.0), kRows, kNoise);
  CHECK_THROWS_WITH_AS(prepare(with(kBounded, "rounds", std::int64_t{0}), unstable),
                       doctest::Contains("L is too small"), InvalidInput);
  CHECK_NOTHROW(
      prepare({{"threshold", 1.0}}, Model(kModel.A(), longer)));  // no bound asked for: anything goes
}

TEST_CASE("different starts are refused where a promise rests on equal ones") {
  RunOptions o;
  o.start = Matrix::Zero(1, 3);
  o.start(0, 2) = 0.5;
  const auto run = [&](const ParamMap& params) {
    simulate(kModel, Network::path(3), *make_filter("saturation", params), {5, {}, 0.0, "none"}, o);
  };
  CHECK_THROWS_WITH_AS(run(with(kBounded, "detector", true)), doctest::Contains("agents 0 and 2"),
                       InvalidInput);
  CHECK_NOTHROW(run({{"threshold", 1.0}}));
  o.start = Matrix::Zero(1, 2);
  CHECK_THROWS_WITH_AS(run({{"threshold", 1.0}}),
                       doctest::Contains("got 2 x 1 numbers, expected 1 x 1 or 3 x 1; agents x states"),
                       InvalidInput);
}

TEST_CASE("drivers refuse what does not fit") {
  const auto filter = make_filter("saturation", {{"threshold", 1.0}});
  const Network net = Network::path(3);
  RunOptions o;
  CHECK_THROWS_WITH_AS(simulate(kModel, net, *filter, {0, {}, 0.0, "auto"}, o),
                       doctest::Contains("steps: got 0"), InvalidInput);
  CHECK_THROWS_WITH_AS(simulate(kModel, net, *filter, {5, Vector::Zero(2), 0.0, "auto"}, o),
                       doctest::Contains("x0: got 2 numbers"), InvalidInput);
  CHECK_THROWS_WITH_AS(simulate(kModel, net, *filter, {5, {}, 0.0, "loud"}, o),
                       doctest::Contains("noise: got unknown name \"loud\""), InvalidInput);
  CHECK_THROWS_WITH_AS(simulate(kModel, net, *filter, {5, {}, 0.0, "normal"}, o),
                       doctest::Contains("covariances"), InvalidInput);
  CHECK_THROWS_WITH_AS(replay(kModel, net, *filter, Matrix::Zero(4, 2), Matrix(), o),
                       doctest::Contains("measurements: got 4 x 2"), InvalidInput);
  CHECK_THROWS_WITH_AS(replay(kModel, net, *filter, Matrix::Zero(4, 3), Matrix::Zero(4, 1), o),
                       doctest::Contains("truth: got 4 x 1"), InvalidInput);
  o.trials = 0;
  CHECK_THROWS_AS(simulate(kModel, net, *filter, {5, {}, 0.0, "auto"}, o), InvalidInput);
  o.trials = 1;
  o.link.drop = 2.0;
  CHECK_THROWS_WITH_AS(simulate(kModel, net, *filter, {5, {}, 0.0, "auto"}, o),
                       doctest::Contains("link.drop: got 2"), InvalidInput);
}

TEST_CASE("a check refuses what design refuses, and says which assumption of the bounds is missing") {
  const Network net = Network::path(3);
  const auto too_many =
      make_filter("saturation", {{"threshold", 1.0}, {"attacked", std::int64_t{4}}, {"initial_error", 1.0}});
  CHECK_THROWS_WITH_AS(too_many->check(kModel, net), doctest::Contains("saturation.attacked: got 4"),
                       InvalidInput);
  CHECK_THROWS_AS(make_filter("saturation", {})->check(kModel, net), InvalidInput);
  const Model no_noise(kModel.A(), {kModel.C(0), kModel.C(1), kModel.C(2)});
  const Check c =
      make_filter("saturation", {{"threshold", 1.0}, {"initial_error", 1.0}})->check(no_noise, net);
  CHECK(!c.holds());
  const auto noise = std::find_if(c.conditions.begin(), c.conditions.end(),
                                  [](const Condition& one) { return one.name == "noise bounds known"; });
  REQUIRE(noise != c.conditions.end());
  CHECK(!noise->holds);
  CHECK(noise->required);
}

TEST_CASE("several outputs, relays and gaps are ordinary") {
  Matrix two(2, 2);
  two << 1, 0, 0, 1;
  const Model model(0.9 * Matrix::Identity(2, 2), {two, Matrix(0, 2), two.row(0)});
  RunOptions o;
  o.threads = 1;
  const Record r = simulate(model, Network::path(3), *make_filter("saturation", {{"threshold", 2.0}}),
                            {80, Vector::Ones(2), 0.0, "none"}, o);
  CHECK(r.error.back() < 1e-3);
  CHECK(r.verdict[1] == static_cast<std::uint8_t>(Verdict::silent));
}
