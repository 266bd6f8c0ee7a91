// SPDX-License-Identifier: Apache-2.0
// A network on two and three ranks has the bits of one engine.
#include <doctest/doctest.h>

#include <cstring>

#include "garrison/attacks/registry.hpp"
#include "parts.hpp"

using namespace garrison;

namespace {

struct Case {
  std::string family;
  ParamMap params;
};
const ParamMap kBounded{
    {"rounds", std::int64_t{12}}, {"attacked", std::int64_t{2}}, {"initial_error", 2.0}, {"threshold", 0.5}};

std::vector<Case> cases() {
  ParamMap detector = kBounded;
  detector.insert({"detector", true});
  return {{"saturation", {{"threshold", 0.3}, {"rounds", std::int64_t{3}}, {"step", 0.1}}},
          {"saturation", {{"threshold", 0.3}, {"rounds", std::int64_t{7}}, {"chebyshev", true}}},
          {"saturation", detector},
          {"scalar_gain", {{"rounds", std::int64_t{2}}, {"step", 0.1}}},
          {"scalar_gain", {{"rounds", std::int64_t{0}}, {"step", 0.1}}},
          {"dkf", {}},
          {"rdkf", {{"weight", 0.5}, {"penalty", std::string("huber")}, {"initial_error", 2.0}}},
          {"rdkf", {{"weight", 0.5}, {"penalty", std::string("group")}}},
          {"partial_sharing", {{"gain", 0.1}, {"shared", std::int64_t{1}}}},
          {"partial_sharing",
           {{"gain", 0.1}, {"gains", std::string("steady")}, {"starts", std::string("coordinated")}}},
          {"structural", {}},
          {"structural", {{"window", std::int64_t{3}}, {"isolate", true}, {"settle", std::int64_t{0}}}}};
}

PlantOptions plant(int steps, const std::string& law) {
  PlantOptions p;
  p.steps = steps;
  p.start_error = 0.1;
  p.noise = law;
  return p;
}
RunOptions options(Matrix start) {
  RunOptions o;
  o.seed = 7;
  o.start = std::move(start);
  return o;
}
/// `trouble`: what is put on the run, by name.
RunOptions troubled(const std::string& trouble, const Vector& start) {
  RunOptions o = options(start);
  const Schedule some(2, {1, 4, 8});
  if (trouble == "drop") o.link.drop = 0.2;
  if (trouble == "delay") o.link = {.drop = 0.1, .delay = 0.2};
  if (trouble == "cut") o.link.cuts = {{.sender = 3, .receiver = -1, .start = 2, .stop = 5}};
  if (trouble == "forge") o.message_attacks = {forge(some, 0.7, false)};
  if (trouble == "equivocate") o.message_attacks = {equivocate(some, 0.4)}, o.link.drop = 0.1;
  if (trouble == "outdated") o.message_attacks = {outdated(some, 2)};
  if (trouble == "not a number") o.message_attacks = {forge(some, kNaN, true)};
  if (trouble == "bias") o.attacks = {bias(some, 5.0), random_noise(Schedule(3, {2}), "laplace", 1.0, false)};
  if (trouble == "denial") o.attacks = {denial(Schedule(3, {0, 2, 3, 5, 7}, 6))};
  if (trouble == "replay") o.attacks = {replayed(some, 2), autoregressive(some, 0.9, 0.3)};
  if (trouble == "story") o.attacks = {false_trajectory(some, start, {})};
  if (trouble == "huge") o.attacks = {constant(some, 1e149), scale(some, 1e2)};
  return o;
}

/// Recovery: bounds and losses go from agent to agent, round by round.
Case recovering() {
  return {"saturation",
          {{"rounds", std::int64_t{8}},
           {"chebyshev", true},
           {"attacked", std::int64_t{1}},
           {"initial_error", 2.0},
           {"threshold", 0.5},
           {"detector", true},
           {"table", true},
           {"recovery", true}}};
}

void check_same(const partition::Whole& whole, const Case& c, const PlantOptions& plant_options,
                const RunOptions& o, std::uint64_t seed) {
  const Record one = simulate(whole.model, whole.network, *make_filter(c.family, c.params), plant_options, o);
  const auto start = static_cast<std::size_t>(whole.model.agents() * whole.model.states());
  for (const int ranks : {1, 2, 3}) {
    CAPTURE(ranks);
    test::Rng rng(seed + static_cast<std::uint64_t>(ranks));
    const auto owner = test::random_owners(rng, whole.model.agents(), ranks);
    std::vector<std::vector<std::byte>> states;  // where ghosts are one hop away
    for (const int halo : {1, 2, 3, 12}) {
      if (halo > std::max(1, partition::rounds_of(c.family, c.params))) continue;
      CAPTURE(halo);
      const auto parts =
          test::run_parts(whole, c.family, c.params, plant_options, o, owner, ranks, false, halo);
      REQUIRE(one.estimate.size() == start + parts.values.size());
      CHECK(std::memcmp(one.estimate.data() + start, parts.values.data(), parts.values.size() * 8) == 0);
      CHECK(one.link.sent == parts.link.sent);
      CHECK(one.link.lost == parts.link.lost);
      CHECK(one.link.late == parts.link.late);
      CHECK(one.link.forged == parts.link.forged);
      CHECK(one.link.refused == parts.link.refused);
      CHECK(one.overflows == parts.overflows);
      CHECK(one.resets == parts.resets);
      if (states.empty()) states = parts.states;
      CHECK(states == parts.states);
    }
  }
}

}  // namespace

TEST_CASE("estimates, counters and restarts of every family are those of one engine, whatever happens") {
  for (const std::string trouble : {"none", "drop", "delay", "cut", "forge", "equivocate", "outdated",
                                    "not a number", "bias", "denial", "replay", "story", "huge"})
    for (const int n : {2, 4, 9}) {
      test::Rng rng(static_cast<std::uint64_t>(100 + n));
      const partition::Whole whole{test::scalar_model(rng, n, 11, 0.98, 0.02, 0.01),
                                   test::connected_network(rng, 11, 0.15)};
      const Vector start = Vector::Constant(n, 0.3);
      for (const Case& c : cases()) {
        CAPTURE(trouble);
        CAPTURE(n);
        CAPTURE(c.family);
        check_same(whole, c, plant(8, "auto"), troubled(trouble, start), 5);
      }
    }
}

TEST_CASE(
    "far ghosts are worked out as their own ranks do, on rings, chains and strips through several ranks") {
  for (const std::string trouble : {"none", "delay", "forge", "outdated", "huge", "denial"})
    for (const Network& network : {Network::path(26), Network::ring(26), Network::grid(2, 13)}) {
      test::Rng rng(31);
      const partition::Whole whole{test::scalar_model(rng, 2, 26, 0.98, 0.02, 0.01), network};
      std::vector<std::int32_t> strips;
      for (int i = 0; i < 26; ++i) strips.push_back(i / 3 % 5);  // every rank has two or more pieces
      for (const Case& c : cases()) {
        if (partition::rounds_of(c.family, c.params) < 2) continue;
        CAPTURE(trouble);
        CAPTURE(c.family);
        const RunOptions o = troubled(trouble, Vector::Constant(2, 0.3));
        const auto run = [&](int halo) {
          return test::run_parts(whole, c.family, c.params, plant(5, "auto"), o, strips, 5, false, halo);
        };
        const auto near = run(1);
        const Record one =
            simulate(whole.model, whole.network, *make_filter(c.family, c.params), plant(5, "auto"), o);
        CHECK(std::memcmp(one.estimate.data() + 52, near.values.data(), near.values.size() * 8) == 0);
        for (const int halo : {2, 3, 4, 7}) {
          CAPTURE(halo);
          const auto far = run(std::min(halo, partition::rounds_of(c.family, c.params)));
          CHECK(std::memcmp(near.values.data(), far.values.data(), near.values.size() * 8) == 0);
          CHECK(near.states == far.states);
          CHECK(near.link.sent == far.link.sent);
          CHECK(near.link.lost == far.link.lost);
          CHECK(near.link.forged == far.link.forged);
        }
      }
    }
}

TEST_CASE("what an agent knows of losses is the same on far ghosts") {
  test::Rng rng(17);
  const partition::Whole whole{test::scalar_model(rng, 2, 9, 0.9, 0.02, 0.01),
                               test::connected_network(rng, 9, 0.2)};
  for (const std::string trouble : {"drop", "cut", "equivocate"})
    check_same(whole, recovering(), plant(12, "auto"), troubled(trouble, Vector::Constant(2, 0.3)), 4);
}

TEST_CASE("noise is drawn under public ids for every law") {
  test::Rng rng(3);
  const partition::Whole whole{test::scalar_model(rng, 2, 9, 0.98, 0.02, 0.01),
                               test::connected_network(rng, 9)};
  for (const std::string law : {"uniform", "extreme", "normal", "none"}) {
    CAPTURE(law);
    check_same(whole, cases()[3], plant(5, law), options({}), 9);
  }
}

TEST_CASE("states saved on two ranks go on on three with the same bits") {
  test::Rng rng(12);
  const partition::Whole whole{test::scalar_model(rng, 4, 11, 0.98, 0.02, 0.01),
                               test::connected_network(rng, 11, 0.2)};
  const Vector start = Vector::Constant(4, 0.3);
  for (const std::string trouble : {"none", "drop", "forge", "replay"})
    for (const Case& c : cases()) {
      CAPTURE(trouble);
      CAPTURE(c.family);
      const RunOptions o = troubled(trouble, start);
      const Record one =
          simulate(whole.model, whole.network, *make_filter(c.family, c.params), plant(8, "auto"), o);
      std::vector<std::vector<std::byte>> saved(11);
      const bool needs = !partition::needs_whole(c.family, c.params, 11).empty();
      const auto run = [&](int ranks, std::int64_t from, std::int64_t to) {
        const auto owner = test::random_owners(rng, 11, ranks);
        test::FakeWorld world(ranks);
        world.run([&](partition::Exchange& exchange) {
          const test::Part part = test::part_of(whole, owner, exchange.rank());
          const auto runner = partition::part_runner(c.family, c.params, needs ? &whole : nullptr, part.model,
                                                     part.region, exchange);
          partition::PartRun trial(*runner, part.model, part.ids, 11, plant(8, "auto"), o);
          trial.start();
          trial.skip_to(from);
          for (std::size_t k = 0; k < part.ids.size() && from > 0; ++k)
            runner->load(static_cast<int>(k), saved[static_cast<std::size_t>(part.ids[k])]);
          while (trial.sample() < to) trial.advance();
          std::vector<double> here(part.ids.size() * 4);
          runner->estimates(here.data());
          for (std::size_t k = 0; k < part.ids.size(); ++k) {
            auto& state = saved[static_cast<std::size_t>(part.ids[k])];
            state.clear();
            runner->save(static_cast<int>(k), state);
            const auto at = static_cast<std::size_t>(to) * 11 + static_cast<std::size_t>(part.ids[k]);
            CHECK(std::memcmp(one.estimate.data() + 4 * at, here.data() + 4 * k, 32) == 0);
          }
        });
      };
      run(2, 0, 3);
      run(3, 3, 8);
    }
}

TEST_CASE("families that do not run on many ranks are refused by name") {
  CHECK_THROWS_WITH_AS(partition::require_family("platoon", "name"), doctest::Contains("\"platoon\""),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(partition::needs_whole("lfre", {}, 11),
                       doctest::Contains("saturation, scalar_gain, rdkf"), InvalidInput);
}

TEST_CASE("the resilient Kalman filter designed by two and three ranks together has the bits of one design") {
  const std::vector<Case> some{
      {"dkf", {}},
      {"rdkf", {{"weight", 0.5}}},
      {"rdkf", {{"weight", 0.5}, {"penalty", std::string("l1")}}},
      {"rdkf", {{"weight", 0.5}, {"penalty", std::string("huber")}, {"initial_error", 2.0}}}};
  for (const int n : {2, 4, 9})
    for (const Case& c : some) {
      CAPTURE(n);
      CAPTURE(c.family);
      test::Rng rng(static_cast<std::uint64_t>(60 + n));
      const partition::Whole whole{test::scalar_model(rng, n, 13, 0.98, 0.02, 0.01),
                                   test::connected_network(rng, 13, 0.15)};
      const RunOptions o = troubled("drop", Vector::Constant(n, 0.3));
      const Record one =
          simulate(whole.model, whole.network, *make_filter(c.family, c.params), plant(6, "auto"), o);
      for (const int ranks : {1, 2, 3}) {
        const auto owner = test::random_owners(rng, 13, ranks);
        const auto parts =
            test::run_parts(whole, c.family, c.params, plant(6, "auto"), o, owner, ranks, true);
        CHECK(std::memcmp(one.estimate.data() + 13 * n, parts.values.data(), parts.values.size() * 8) == 0);
      }
    }
}

TEST_CASE("a plant for which the sweeps do not settle is refused by all ranks, one that nobody sees too") {
  test::Rng rng(2);
  const Network network = test::connected_network(rng, 8);
  const auto owner = test::random_owners(rng, 8, 2);
  const auto refusal = [&](const Matrix& A, const Matrix& row, double process) -> std::string {
    Noise noise;
    noise.process_covariance = process * Matrix::Identity(2, 2);
    noise.measurement_covariance.assign(8, Matrix::Identity(1, 1));
    const partition::Whole whole{Model(A, std::vector<Matrix>(8, row), noise), network};
    try {
      test::run_parts(whole, "dkf", {}, plant(2, "none"), options({}), owner, 2, true);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "designed";
  };
  Matrix integrators = Matrix::Identity(2, 2);
  integrators(0, 1) = 1e-3;
  Matrix first = Matrix::Zero(1, 2);
  first(0, 0) = 1.0;
  CHECK(refusal(integrators, first, 1e-9).find("Newton") != std::string::npos);
  CHECK(refusal(1.2 * Matrix::Identity(2, 2), first, 1.0).find("grow") != std::string::npos);
}
