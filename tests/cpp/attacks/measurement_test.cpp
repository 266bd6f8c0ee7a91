// SPDX-License-Identifier: Apache-2.0
#include "garrison/attacks/measurement.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "../random_system.hpp"
#include "garrison/attacks/registry.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

const Model kModel(Matrix::Constant(1, 1, 0.5), std::vector<Matrix>(3, Matrix::Ones(1, 1)));

struct Fixed final : Victims {
  void expected(int agent, double* out) const override { *out = 10.0 * agent; }
  double alarm_level(int) const override { return 2.0; }
};

/// What each agent says at t = 1..8 when its true measurement is t + agent.
Matrix said(const Attack& plan, std::uint64_t seed = 1) {
  const Fixed victims;
  auto attack = plan->start(kModel, Random(seed, 0, Purpose::attack), 1);
  Matrix out(8, 3);
  for (int t = 1; t <= 8; ++t) {
    std::vector<double> y{1.0 * t, t + 1.0, t + 2.0};
    attack->apply({t, y, victims});
    for (int i = 0; i < 3; ++i) out(t - 1, i) = y[static_cast<std::size_t>(i)];
  }
  return out;
}

Schedule one(std::int64_t start = 3, std::int64_t stop = 6) { return Schedule(start, {1}, stop); }

}  // namespace

TEST_CASE("attacks touch their agents at their times and nothing else") {
  const Matrix honest = said(bias(one(), 0.0));
  const Matrix y = said(bias(one(), 5.0));
  for (int t = 1; t <= 8; ++t)
    for (int i = 0; i < 3; ++i)
      CHECK(y(t - 1, i) == honest(t - 1, i) + (i == 1 && t >= 3 && t < 6 ? 5.0 : 0.0));
}

TEST_CASE("each attack says what its description says") {
  CHECK(said(scale(one(), 3.0))(2, 1) == 12.0);
  CHECK(said(constant(one(), 1e300))(2, 1) == 1e300);
  CHECK(std::isnan(said(denial(one()))(4, 1)));
  CHECK(said(ramp(one(), 0.5))(4, 1) == 6.0 + 1.5);
  CHECK(said(sinusoid(one(), 2.0, 4.0, 0.0))(3, 1) == doctest::Approx(5.0 + 2.0));
  CHECK(said(replayed(one(), 2))(3, 1) == 3.0);   // t = 4 says what t = 2 was
  CHECK(said(replayed(one(), 20))(3, 1) == 2.0);  // nothing that old: the first sample
  CHECK(said(stealthy(one(), -0.5))(2, 1) == 10.0 - 1.0);
  const Matrix story = said(false_trajectory(Schedule(2, {0, 2}), Vector::Constant(1, 8.0), {}));
  CHECK(story(1, 0) == 2.0 + 8.0);
  CHECK(story(2, 2) == 5.0 + 4.0);  // the displacement obeys the plant: 8, 4, 2, ...
  CHECK(story(3, 0) == 4.0 + 2.0);
  const Matrix noisy = said(autoregressive(one(1, 9), 0.9, 1.0));
  CHECK(noisy.col(1) != said(bias(one(), 0.0)).col(1));
}

TEST_CASE("laws have their sizes, seeds decide") {
  for (const char* law : {"uniform", "normal", "laplace", "cauchy"}) {
    CHECK(said(random_noise(one(1, 9), law, 2.0, true), 4) ==
          said(random_noise(one(1, 9), law, 2.0, true), 4));
    CHECK(said(random_noise(one(1, 9), law, 2.0, true), 4) !=
          said(random_noise(one(1, 9), law, 2.0, true), 5));
  }
  const Matrix uniform = said(random_noise(one(1, 9), "uniform", 2.0, true));
  CHECK(uniform.col(1).cwiseAbs().maxCoeff() <= 2.0);
  CHECK_THROWS_WITH_AS(random_noise(one(), "gauss", 1.0, false), doctest::Contains("one of: uniform, normal"),
                       InvalidInput);
}

TEST_CASE("schedules: phases, chance, refusals") {
  const Schedule moving(std::vector<Schedule::Phase>{{2, {0}}, {5, {1, 2}}}, 8);
  CHECK(moving.agents(1).empty());
  CHECK(moving.agents(4).size() == 1);
  CHECK(moving.agents(7).size() == 2);
  CHECK(moving.agents(8).empty());
  CHECK(moving.everyone() == std::vector<int>{0, 1, 2});
  const Schedule chance(0, {2}, Schedule::kForever, 0.3);
  const Random random(1, 0, Purpose::attack);
  int hits = 0;
  for (int t = 0; t < 10000; ++t) hits += chance.strikes(random, t, 0, 1) ? 1 : 0;
  CHECK(std::abs(hits - 3000) < 200);
  CHECK_THROWS_WITH_AS(Schedule(std::vector<Schedule::Phase>{{5, {0}}, {5, {1}}}),
                       doctest::Contains("a time after 5"), InvalidInput);
  CHECK_THROWS_AS(Schedule(5, {2}, 5), InvalidInput);
  CHECK_THROWS_AS(Schedule(5, {2}, 9, 1.5), InvalidInput);
  CHECK_THROWS_WITH_AS(bias(Schedule(1, {7}), 1.0)->start(kModel, random, 1), doctest::Contains("7"),
                       InvalidInput);
}

TEST_CASE("an informed attacker stays below the detector's threshold") {
  test::Rng rng(3);
  const Model model = test::scalar_model(rng, 2, 8, 0.95, 0.02, 0.01);
  const Network network = test::connected_network(rng, 8);
  const auto filter = make_filter("saturation", {{"threshold", 0.5},
                                                 {"rounds", std::int64_t{15}},
                                                 {"attacked", std::int64_t{2}},
                                                 {"initial_error", 1.0},
                                                 {"detector", true}});
  RunOptions o;
  o.attacks = {stealthy(Schedule(1, {1, 4}), 0.999)};
  o.keep.signals = true;
  const Record record = simulate(model, network, *filter, {60, {}, 0.5, "uniform"}, o);
  CHECK(record.accusations.size() == 1);  // the empty sets of time 0
  o.attacks = {stealthy(Schedule(1, {1, 4}), 1.01)};
  CHECK(simulate(model, network, *filter, {60, {}, 0.5, "uniform"}, o).accusations.size() > 1);
}

TEST_CASE("attacks by name") {
  CHECK(attack_infos().size() == 18);
  CHECK_THROWS_WITH_AS(make_attack("bais", one(), {}), doctest::Contains("did you mean \"bias\"?"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(make_attack("bias", one(), {}), doctest::Contains("bias.value: got no value"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(make_attack("scale", one(), {{"fcator", 2.0}}),
                       doctest::Contains("did you mean \"factor\"?"), InvalidInput);
  CHECK(make_attack("silence", one(), {}).message != nullptr);
}
