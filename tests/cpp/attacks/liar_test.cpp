// SPDX-License-Identifier: Apache-2.0
// What one agent that lies in its messages can do, family by family, as the doc of each family says.
#include <doctest/doctest.h>

#include "../filters/platoon/random_platoon.hpp"
#include "../random_system.hpp"
#include "garrison/attacks/registry.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

constexpr int kAgents = 7;

Model model() {
  test::Rng rng(5);
  return test::scalar_model(rng, 2, kAgents, 0.95, 0.01, 0.01);
}

Record run(const char* name, ParamMap params, std::vector<std::shared_ptr<const MessageAttack>> lies,
           int steps = 40) {
  RunOptions o;
  o.message_attacks = std::move(lies);
  return simulate(model(), Network::complete(kAgents), *make_filter(name, params),
                  {steps, {}, 0.0, "uniform", {}}, o);
}

/// Largest error of honest agents (all but 2).
double worst(const Record& r) {
  double most = 0.0;
  for (std::size_t k = 0; k < r.error.size(); ++k)
    if (k % kAgents != 2) most = std::max(most, r.error[k]);
  return most;
}

int count(const Record& r, Verdict verdict) {
  return static_cast<int>(std::count(r.verdict.begin(), r.verdict.end(), static_cast<std::uint8_t>(verdict)));
}

}  // namespace

TEST_CASE("families that average move in proportion to the lie, and say that no bound is claimed") {
  const std::vector<std::pair<const char*, ParamMap>> averaging{{"saturation",
                                                                 {{"threshold", 0.5},
                                                                  {"initial_error", 1.0},
                                                                  {"attacked", std::int64_t{1}},
                                                                  {"rounds", std::int64_t{9}}}},
                                                                {"scalar_gain", {}},
                                                                {"rdkf", {{"initial_error", 1.0}}},
                                                                {"dkf", {}},
                                                                {"structural", {}},
                                                                {"partial_sharing", {{"gain", 0.1}}}};
  for (const auto& [name, params] : averaging) {
    CAPTURE(name);
    const auto small = run(name, params, {forge(Schedule(5, {2}), 10.0, false)});
    const auto large = run(name, params, {forge(Schedule(5, {2}), 1000.0, false)});
    CHECK(worst(large) > 20.0 * worst(small));
    CHECK(worst(small) > 5.0 * worst(run(name, params, {})));
    for (const double bound : large.bound) CHECK(std::isnan(bound));
    CHECK(std::any_of(large.warnings.begin(), large.warnings.end(), [](const std::string& one) {
      return one.find("lie in their messages") != std::string::npos;
    }));
  }
}

TEST_CASE("lfre trims up to f liars away, and no more") {
  const Model chain(0.9 * Matrix::Identity(2, 2) + 0.1 * Matrix{{0.0, 1.0}, {0.0, 0.0}},
                    [] {
                      std::vector<Matrix> C(kAgents, Matrix::Zero(0, 2));  // four sources, three that listen
                      for (std::size_t i = 0; i < 4; ++i) C[i] = Matrix{{1.0, 0.0}};
                      return C;
                    }(),
                    {0.01, Vector::Constant(kAgents, 0.01)});
  const auto error = [&](std::vector<int> liars) {
    RunOptions o;
    o.message_attacks = {forge(Schedule(5, std::move(liars)), 1e6, true)};
    const Record r =
        simulate(chain, Network::complete(kAgents), *make_filter("lfre", {{"faulty", std::int64_t{1}}}),
                 {40, {}, 0.0, "uniform", {}}, o);
    return *std::max_element(r.error.end() - 3, r.error.end());
  };
  CHECK(error({0}) < 1.0);
  CHECK(error({0, 1}) > 1e3);
}

TEST_CASE("a structural agent that lies about itself has nobody accused") {
  const auto honest = run("structural", {}, {});
  for (const auto& [field, value] :
       std::vector<std::pair<const char*, double>>{{"rest", 9.0}, {"covariance", 1e6}}) {
    CAPTURE(field);
    const auto r = run("structural", {}, {falsify(Schedule(1, {2}), field, value, {})});
    CHECK(count(r, Verdict::attacked) <=
          count(honest, Verdict::attacked) + 3);  // every agent judges itself alone
  }
}

TEST_CASE("a forged bound of rdkf would be believed, and is not reported") {
  const auto r = run("rdkf", {{"initial_error", 1.0}}, {falsify(Schedule(5, {2}), "bound", 0.0, {})});
  for (const double bound : r.bound) CHECK(std::isnan(bound));
}

TEST_CASE("a vehicle that lies has anybody isolated, and no bound is reported") {
  test::Rng rng(9);
  const auto p = test::random_platoon(rng);
  const auto start = test::random_start(rng, p.setting);
  RunOptions o;
  o.start = start.estimate;
  o.message_attacks = {falsify(Schedule(5, {0}), "attacked", 0.0, {1})};
  const Record r =
      simulate(p.model, p.network, *make_filter("platoon", p.params), {20, start.x0, 0.0, "uniform", {}}, o);
  bool isolated = false;
  for (const auto& entry : r.accusations)
    for (const auto& set : entry.sets) isolated = isolated || set == std::vector<int>{1};
  CHECK(isolated);
  for (const double bound : r.bound) CHECK(std::isnan(bound));
}

TEST_CASE("old content under a new stamp is taken for new: a liar's choice, not a fault of links") {
  const auto r = run("structural", {}, {outdated(Schedule(5, {2}), 3)});
  CHECK(r.link.forged == 6 * 36);
  CHECK(worst(r) < 1.0);
}
