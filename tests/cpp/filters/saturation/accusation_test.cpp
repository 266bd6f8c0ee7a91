// SPDX-License-Identifier: Apache-2.0
// No honest sensor is ever proved attacked, whatever links, restarts and measurements do.
#include <doctest/doctest.h>

#include "../../every_filter.hpp"
#include "../../random_system.hpp"
#include "garrison/attacks/registry.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

/// Sensors other than `victims` that somebody calls attacked.
int accused_honest(const Record& r, const std::vector<int>& victims) {
  int wrong = 0;
  for (const auto& entry : r.accusations)
    for (const auto& set : entry.sets)
      for (const int id : set)
        wrong += std::find(victims.begin(), victims.end(), id) == victims.end() ? 1 : 0;
  return wrong;
}

ParamMap detecting(int attacked, int rounds, double threshold = 0.3) {
  return {{"threshold", threshold},
          {"rounds", std::int64_t{rounds}},
          {"attacked", std::int64_t{attacked}},
          {"initial_error", 1.0},
          {"detector", true}};
}

}  // namespace

TEST_CASE("300 random systems under loss and delay: no honest sensor is proved attacked") {
  test::Rng rng(11);
  for (int run = 0; run < test::tried(300); ++run) {
    const int N = test::whole(rng, 4, 9);
    const int n = test::whole(rng, 1, 3);
    const Model model = test::scalar_model(rng, n, N, test::uniform(rng, 0.9, 1.02), 0.01, 0.01);
    const Network network = test::connected_network(rng, N);
    const int victim = test::whole(rng, 0, N - 1);
    const auto filter = make_filter("saturation", detecting(1, test::whole(rng, 3, 30)));
    for (const double drop : {0.1, 0.3, 0.5, 0.9}) {
      RunOptions o;
      o.seed = static_cast<std::uint64_t>(run);
      o.link.drop = drop;
      o.link.delay = run % 2 == 0 ? 0.3 : 0.0;
      o.link.delay_rounds = 1 + run % 10;
      o.start = Matrix::Zero(n, 1);
      o.attacks = {run % 3 == 0 ? stealthy(Schedule(3, {victim}), 0.99) : bias(Schedule(3, {victim}), 0.5)};
      const Record r = simulate(model, network, *filter, {60, {}, 0.9, "extreme", {}}, o);
      CAPTURE(run);
      CAPTURE(drop);
      CHECK(accused_honest(r, {victim}) == 0);
      for (std::size_t k = 0; k < r.bound.size(); ++k)
        if (!std::isnan(r.bound[k])) CHECK(r.error[k] <= r.bound[k]);
    }
  }
}

TEST_CASE("eight agents, complete, one round, late messages, no attack: nobody is accused") {
  test::Rng rng(12);
  const Model model = test::scalar_model(rng, 1, 8, 1.0, 0.01, 0.01);
  RunOptions o;
  o.trials = 100;
  o.link.delay = 0.3;
  o.link.delay_rounds = 4;
  const Record r = simulate(model, Network::complete(8), *make_filter("saturation", detecting(1, 1)),
                            {60, {}, 0.9, "extreme", {}}, o);
  CHECK(accused_honest(r, {}) == 0);
}

TEST_CASE("a path of six with half of its messages lost and one attacked sensor") {
  std::vector<Matrix> C(6, Matrix::Ones(1, 1));
  const Model model(Matrix::Constant(1, 1, 1.009), C, {0.01, Vector::Constant(6, 0.01)});
  for (int trial = 0; trial < 5; ++trial) {
    RunOptions o;
    o.seed = static_cast<std::uint64_t>(trial);
    o.link.drop = 0.5;
    o.attacks = {stealthy(Schedule(1, {4}), 1.0)};
    const Record r = simulate(model, Network::path(6), *make_filter("saturation", detecting(1, 27)),
                              {200, {}, 0.9, "extreme", {}}, o);
    CHECK(accused_honest(r, {4}) == 0);
  }
}

TEST_CASE("what is not tested is not called cleared") {
  test::Rng rng(13);
  const Model model = test::scalar_model(rng, 2, 6, 0.98, 0.01, 0.01);
  const auto count = [&](const char* name, ParamMap params, double drop, Verdict verdict) {
    RunOptions o;
    o.link.drop = drop;
    const Record r =
        simulate(model, Network::ring(6), *make_filter(name, params), {40, {}, 0.0, "uniform", {}}, o);
    int found = 0;
    for (std::size_t k = 6; k < r.verdict.size(); ++k)
      found += r.verdict[k] == static_cast<int>(verdict) ? 1 : 0;
    return found;
  };
  CHECK(count("saturation", detecting(1, 12), 0.0, Verdict::cleared) > 200);
  CHECK(count("saturation", detecting(1, 12), 0.5, Verdict::cleared) < 30);
  CHECK(count("saturation", detecting(1, 12), 0.5, Verdict::not_tested) > 100);
  CHECK(count("scalar_gain", {}, 0.0, Verdict::not_tested) == 240);
  CHECK(count("dkf", {}, 0.0, Verdict::not_tested) == 240);
  CHECK(count("partial_sharing", {{"gain", 0.1}}, 0.0, Verdict::not_tested) == 240);
}

TEST_CASE("no family calls a sensor cleared at a sample without a threshold") {
  test::Rng rng(13);
  const Model model = test::scalar_model(rng, 2, 6, 0.98, 0.01, 0.01);
  for (const auto& filter : test::every_filter()) {
    for (const double drop : {0.0, 0.3}) {
      RunOptions o;
      o.link.drop = drop;
      const Record r = simulate(model, Network::ring(6), *filter, {40, {}, 0.0, "uniform", {}}, o);
      CAPTURE(filter->name());
      for (std::size_t k = 6; k < r.verdict.size(); ++k)
        if (r.verdict[k] == static_cast<std::uint8_t>(Verdict::cleared)) CHECK(!std::isnan(r.threshold[k]));
    }
  }
}

TEST_CASE("one liar among the agents: no bound is claimed, and the run says that accusations are no proofs") {
  test::Rng rng(14);
  const Model model = test::scalar_model(rng, 2, 6, 0.98, 0.01, 0.01);
  const auto filter = make_filter("saturation", detecting(1, 12));
  RunOptions o;
  o.message_attacks = {falsify(Schedule(5, {2}), "proved", 0.0, {4})};
  const Record r = simulate(model, Network::ring(6), *filter, {20, {}, 0.0, "uniform", {}}, o);
  CHECK(accused_honest(r, {}) > 0);  // one message is enough: this is what such a liar can do
  CHECK(std::all_of(r.bound.begin(), r.bound.end(), [](double b) { return std::isnan(b); }));
  REQUIRE(!r.warnings.empty());
  CHECK(r.warnings[0].find("lie in their messages") != std::string::npos);
  o.message_attacks = {falsify(Schedule(5, {2}), "intact", 0.0, {})};
  const Record gap = simulate(model, Network::ring(6), *filter, {20, {}, 0.0, "uniform", {}}, o);
  CHECK(accused_honest(gap, {}) == 0);
  CHECK(gap.verdict.back() == static_cast<int>(Verdict::not_tested));  // and so has all tests switched off
  o.message_attacks = {falsify(Schedule(5, {2}), "prooved", 0.0, {4})};
  CHECK_THROWS_WITH_AS(simulate(model, Network::ring(6), *filter, {20, {}, 0.0, "uniform", {}}, o),
                       doctest::Contains("proved"), InvalidInput);
}
