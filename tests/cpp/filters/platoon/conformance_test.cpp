// SPDX-License-Identifier: Apache-2.0
// What every family owes its drivers, for agents that drive plants of their own.
#include <doctest/doctest.h>

#include <cstring>

#include "../../agents_by_hand.hpp"
#include "garrison/attacks/registry.hpp"
#include "random_platoon.hpp"

using namespace garrison;

namespace {

bool same(const Bulk<double>& a, const Bulk<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("engine, replay and agents driven by hand give the same bits, on any number of threads") {
  test::Rng rng(21);
  for (int run = 0; run < 6; ++run) {
    auto p = test::random_platoon(rng);
    const int N = p.setting.vehicles;
    p.model = platoon::model(N, p.setting.period, true);  // a log of its own closed loop: no inputs are told
    const auto start = test::random_start(rng, p.setting);
    for (const auto& filter : test::every_platoon_filter(p.params)) {
      CAPTURE(filter->name());
      RunOptions o;
      o.trials = 3;
      o.start = start.estimate;
      o.keep.signals = true;
      o.keep.details = true;
      o.attacks = {random_noise(Schedule(2, {0}), "normal", 50.0, false), denial(Schedule(9, {1}, 12)),
                   constant(Schedule(14, {1}), kInfinity)};
      const PlantOptions plant{20, start.x0, 0.0, "uniform", {}};
      o.threads = 1;
      const Record one = simulate(p.model, p.network, *filter, plant, o);
      o.threads = 3;
      const Record three = simulate(p.model, p.network, *filter, plant, o);
      CHECK(same(one.estimate, three.estimate));
      CHECK(same(one.truth, three.truth));
      CHECK(same(one.signals, three.signals));
      CHECK(one.details.size() == three.details.size());
      RunOptions again = o;
      again.attacks.clear();
      const Log log{one.measurements.data(), one.truth.data(), 3, 20};
      const Record replayed = replay(p.model, p.network, *filter, log, again);
      CHECK(same(one.estimate, replayed.estimate));
      CHECK(same(one.error, replayed.error));
      // By hand, the first trial.
      const auto prepared = filter->prepare(p.model, p.network);
      test::AgentsByHand agents(*prepared, p.network);
      for (int i = 0; i < N; ++i) agents[i].reset(start.estimate.col(i));
      const auto M = static_cast<std::size_t>(p.model.total_outputs());
      Bulk<double> estimates;
      for (std::size_t t = 0; t <= 20; ++t) {
        agents.step(static_cast<std::int64_t>(t), [&](int i) {
          const double* y = one.measurements.data() + t * M + p.model.offset(i);
          return Vector(Eigen::Map<const Vector>(y, p.model.outputs(i)));
        });
        agents.append_estimates(estimates);
      }
      const Bulk<double> first(one.estimate.begin(),
                               one.estimate.begin() + static_cast<std::ptrdiff_t>(estimates.size()));
      CHECK(same(estimates, first));
    }
  }
}

TEST_CASE("attacks reach the absolute sensors alone") {
  const Model model = platoon::model(4, 0.1, true);
  for (const auto& attack :
       {bias(Schedule(0, {2}), 5.0), replayed(Schedule(0, {2}), 1), constant(Schedule(0, {2}), 7.0)}) {
    std::vector<double> y(static_cast<std::size_t>(model.total_outputs()), 1.0);
    struct Nobody final : Victims {
      void expected(int, double*) const override {}
      double alarm_level(int) const override { return kNaN; }
    } nobody;
    const auto trial = attack->start(model, Random(1, 0, Purpose::attack), 1);
    trial->apply({0, y, nobody});
    for (std::size_t k = 0; k < y.size(); ++k)
      if (k < static_cast<std::size_t>(model.offset(2)) || k >= static_cast<std::size_t>(model.offset(2)) + 2)
        CHECK(y[k] == 1.0);
  }
}

TEST_CASE("lost, late and forged messages never spread what is not finite") {
  test::Rng rng(22);
  for (int run = 0; run < 10; ++run) {
    const auto p = test::random_platoon(rng);
    const auto start = test::random_start(rng, p.setting);
    for (const auto& filter : test::every_platoon_filter(p.params)) {
      RunOptions o;
      o.start = start.estimate;
      o.link = {0.2, 0.2, 2, {}, {}};
      o.message_attacks = {forge(Schedule(4, {1}), kNaN, true), equivocate(Schedule(6, {0}), 2.0),
                           silence(Schedule(10, {2}))};
      o.attacks = {constant(Schedule(3, {0}), 1e300)};
      const Record r = simulate(p.model, p.network, *filter, {25, start.x0, 0.0, "uniform", {}}, o);
      for (const double v : r.estimate) CHECK(std::isfinite(v));
      CHECK(r.link.refused > 0);
    }
  }
}

TEST_CASE("a string of 3000 vehicles: sets stay small and everybody learns of the attack nearby") {
  const int N = 3000;
  const Model model = platoon::model(N, 0.01);
  ParamMap params{{"attacked", std::int64_t{3}},
                  {"process_noise", 0.1},
                  {"measurement_noise", 0.1},
                  {"initial_error", 300.0},
                  {"threshold", 200.0},
                  {"reference", std::vector<double>{200.0, 10.0}},
                  {"gs", 50.0},
                  {"gv", 50.0}};
  RunOptions o;
  o.attacks = {random_noise(Schedule(1, {1000, 1003, 1010}), "normal", 1e3, false)};
  o.keep.details = true;
  o.keep.estimate = false;
  o.start = Matrix(2, N);
  for (int i = 0; i < N; ++i) o.start.col(i) = Vec<2>(200.0 - 20.0 * i, 10.0);
  const Record r =
      simulate(model, Network::band(N, 3), *make_filter("platoon", params), {12, {}, 0.0, "uniform", {}}, o);
  std::vector<std::vector<double>> attacked(static_cast<std::size_t>(N));
  for (const auto& d : r.details)
    if (d.name == 0) attacked[static_cast<std::size_t>(d.agent)] = d.values;
  CHECK(attacked[1003] == std::vector<double>{1000, 1003, 1010});
  CHECK(attacked[1030] == std::vector<double>{1000, 1003, 1010});
  CHECK(attacked[2000].empty());
  for (std::size_t k = 0; k < r.bound.size(); ++k) CHECK(r.error[k] <= r.bound[k]);
}
