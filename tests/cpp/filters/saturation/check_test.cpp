// SPDX-License-Identifier: Apache-2.0
// What `check` of the saturation filter prints must hold, or be absent; what fails says what to do.
#include <doctest/doctest.h>

#include <iostream>

#include "../../random_system.hpp"
#include "garrison/attacks/registry.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

double quantity(const Check& check, const char* name) {
  for (const auto& q : check.quantities)
    if (q.name == name) return q.value;
  FAIL("no quantity " << name);
  return kNaN;
}

const Condition& condition(const Check& check, const char* name) {
  for (const auto& c : check.conditions)
    if (c.name == name) return c;
  FAIL("no condition " << name);
  return check.conditions.front();
}

}  // namespace

TEST_CASE("star of 8: no uniform bound below 12.34 is printed once sensors stop saturating") {
  const Model model(Matrix{{0.9}}, std::vector<Matrix>(8, Matrix{{1.0}}), {0.0, Vector::Zero(8), {}, {}});
  const Network star = Network::star(8);
  const ParamMap params{{"threshold", 0.1},
                        {"rounds", std::int64_t{1}},
                        {"attacked", std::int64_t{1}},
                        {"initial_error", 10.0},
                        {"detector", true}};
  const Check check = make_filter("saturation", params)->check(model, star);
  const double bound = quantity(check, "uniform bound");
  CHECK((std::isnan(bound) || bound >= 12.34));
  CHECK(quantity(check, "uniform bound, testing sensors") == doctest::Approx(10.24).epsilon(1e-3));
  auto without = params;
  without["detector"] = false;  // Algorithm 1 always saturates: theorem 1 holds as it is
  CHECK(quantity(make_filter("saturation", without)->check(model, star), "uniform bound") ==
        doctest::Approx(10.24).epsilon(1e-3));
}

TEST_CASE("bounds printed with the detector hold when all attackers are proved") {
  test::Rng rng(12);
  int bounded = 0;
  int exposed = 0;
  int above_theorem1 = 0;
  for (int k = 0; k < 400; ++k) {
    const int N = test::whole(rng, 4, 12);
    const int n = test::whole(rng, 1, 2);
    const double noise = test::whole(rng, 0, 1) ? 0.0 : 0.01;
    const Model model = test::scalar_model(rng, n, N, test::uniform(rng, 0.4, 1.02), noise, noise);
    const Network network =
        test::whole(rng, 0, 2) == 0 ? Network::star(N) : test::connected_network(rng, N, 0.4);
    const double eta0 = 10.0;
    const ParamMap params{{"threshold", eta0 * std::pow(10.0, test::uniform(rng, -2, 0))},
                          {"rounds", std::int64_t{test::whole(rng, 1, 6)}},
                          {"attacked", std::int64_t{1}},
                          {"initial_error", eta0},
                          {"detector", true}};
    const auto filter = make_filter("saturation", params);
    const Check check = filter->check(model, network);
    double uniform = kNaN;
    double testing = kNaN;
    for (const auto& q : check.quantities) {
      if (q.name == "uniform bound") uniform = q.value;
      if (q.name == "uniform bound, testing sensors") testing = q.value;
    }
    if (std::isnan(uniform)) continue;
    ++bounded;
    RunOptions o;
    o.seed = static_cast<std::uint64_t>(k);
    o.threads = 1;
    o.attacks = {bias(Schedule(test::whole(rng, 1, 4), {test::whole(rng, 0, N - 1)}), 1e4)};
    const Record r = simulate(model, network, *filter, {60, {}, eta0, "extreme"}, o);
    exposed += r.accusations.empty() ? 0 : 1;
    CAPTURE(k);
    for (std::size_t t = 1; t <= 60; ++t)
      for (std::size_t i = 0; i < static_cast<std::size_t>(N); ++i) {
        const double error = r.error[t * static_cast<std::size_t>(N) + i];
        CHECK(error <= uniform * (1.0 + 1e-9));
        above_theorem1 += error > testing ? 1 : 0;
      }
  }
  CHECK(bounded > 30);
  CHECK(exposed > 30);
  std::cout << "saturation bounds with the detector: " << bounded << " settings, " << exposed << " exposed, "
            << above_theorem1 << " errors above theorem 1, none above the bound printed\n";
}

TEST_CASE("a condition that fails says what to do, and doing it helps") {
  // Threshold small against the noise: the error settles above initial_error.
  const Model model(Matrix{{1.0}}, std::vector<Matrix>(5, Matrix{{1.0}}),
                    {1.0, Vector::Constant(5, 1.0), {}, {}});
  const Network ring = Network::complete(5);
  ParamMap params{{"threshold", 8.0},
                  {"rounds", std::int64_t{1}},
                  {"attacked", std::int64_t{1}},
                  {"initial_error", 0.01}};
  const char* nine = "eta0 (1 - F(eta0)) >= q0 (9)";
  const Check before = make_filter("saturation", params)->check(model, ring);
  const Condition& failed = condition(before, nine);
  REQUIRE_FALSE(failed.holds);
  const std::string asked = "raise initial_error to ";
  const auto at = failed.meaning.find(asked);
  REQUIRE(at != std::string::npos);
  params["initial_error"] = std::stod(failed.meaning.substr(at + asked.size()));
  CHECK(condition(make_filter("saturation", params)->check(model, ring), nine).holds);
}

TEST_CASE("a threshold that saturates honest sensors is told how far to rise") {
  const Model model(Matrix{{1.0}}, std::vector<Matrix>(6, Matrix{{1.0}}),
                    {0.1, Vector::Constant(6, 0.1), {}, {}});
  const Network ring = Network::ring(6);
  ParamMap params{{"threshold", 2.0},
                  {"rounds", std::int64_t{10}},
                  {"attacked", std::int64_t{1}},
                  {"initial_error", 5.0}};
  const char* twelve = "(beta - b_w - b_v)/a > rho_1 + p0 (12)";
  const Check low = make_filter("saturation", params)->check(model, ring);
  REQUIRE_FALSE(condition(low, twelve).holds);
  const std::string raise = "raise threshold to ";
  const std::string& words = condition(low, twelve).meaning;
  const auto number = words.find(raise);
  REQUIRE(number != std::string::npos);
  params["threshold"] = std::stod(words.substr(number + raise.size()));
  CHECK(condition(make_filter("saturation", params)->check(model, ring), twelve).holds);
}
