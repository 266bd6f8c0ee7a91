// SPDX-License-Identifier: Apache-2.0
// A search for violated promises: bounds, accusations and clearances of random closed loops.
#include <doctest/doctest.h>

#include <set>

#include "string_by_hand.hpp"

using namespace garrison;

namespace {

/// What must never happen in runs that meet the assumptions.
struct Faults {
  int bound_violated = 0;
  int accused_clean = 0;
  int cleared_attacked = 0;
  int doubted = 0;  // a vehicle that no longer vouches
  int gap_wrong = 0;
  double worst = -kInfinity;  // error - bound
};

Faults count_faults(const Record& r, const std::vector<int>& victims) {
  Faults f;
  const auto N = static_cast<std::size_t>(r.agents);
  const std::set<int> bad(victims.begin(), victims.end());
  const auto rows = static_cast<std::size_t>(r.steps + 1);
  const std::size_t names = r.signal_names.size();
  for (std::size_t t = 0; t < rows; ++t) {
    for (std::size_t i = 0; i < N; ++i) {
      const double bound = r.bound[t * N + i];
      const double* signal = r.signals.data() + t * N * names + i;
      if (signal[6 * N] != 0.0 || std::isnan(bound)) ++f.doubted;
      const double over = r.error[t * N + i] - bound;
      f.worst = std::max(f.worst, over);
      if (over > 0.0) ++f.bound_violated;  // no allowance: the bound has one for rounding
      if (i == 0) continue;
      const double gap = r.truth[(t * N + i - 1) * 2] - r.truth[(t * N + i) * 2];
      if (signal[7 * N] > gap || std::abs(gap - 20.0) > signal[8 * N]) ++f.gap_wrong;
    }
  }
  for (const auto& d : r.details) {
    for (const double id : d.values) {
      const bool attacked = bad.count(static_cast<int>(id)) != 0;
      if (d.name == 0 && !attacked) ++f.accused_clean;
      if (d.name == 2 && attacked) ++f.cleared_attacked;
    }
  }
  return f;
}

RunOptions options(const test::Start& start, std::uint64_t seed) {
  RunOptions o;
  o.seed = seed;
  o.threads = 1;
  o.start = start.estimate;
  o.keep = {true, true, true, false, true};
  return o;
}

void search(int runs, std::uint64_t seed, const ParamMap& more, bool faulty_links) {
  test::Rng rng(seed);
  const char* const laws[] = {"uniform", "extreme", "one_sided", "none"};
  for (int run = 0; run < runs; ++run) {
    const auto p = test::random_platoon(rng);
    const auto victims = test::random_victims(rng, p.setting);
    ParamMap params = p.params;
    for (const auto& [name, value] : more) params[name] = value;
    const auto start = test::random_start(rng, p.setting);
    RunOptions o = options(start, seed * 10000 + static_cast<std::uint64_t>(run));
    o.attacks = test::random_attack(rng, p.setting, victims);
    if (faulty_links) o.link = {0.15, 0.15, 1, {}, {}};
    PlantOptions plant{35, start.x0, 0.0, laws[run % 4], {}};
    const Record r = simulate(p.model, p.network, *make_filter("platoon", params), plant, o);
    const Faults f = count_faults(r, victims);
    CAPTURE(run);
    CAPTURE(seed);
    CAPTURE(p.setting.vehicles);
    CAPTURE(p.setting.range);
    CAPTURE(p.setting.attacked);
    CAPTURE(victims.size());
    CAPTURE(f.worst);
    CHECK(f.bound_violated == 0);
    CHECK(f.accused_clean == 0);
    CHECK(f.cleared_attacked == 0);
    CHECK(f.doubted == 0);
    CHECK(f.gap_wrong == 0);
  }
}

}  // namespace

TEST_CASE("no bound is violated and nobody is falsely accused or cleared, in 400 random closed loops") {
  search(400, 1, {}, false);
}

TEST_CASE("the same with the tight bound, the stronger tests, and all of them: 200 loops each") {
  search(200, 2, {{"bound", std::string("tight")}, {"tie", std::string("bound")}}, false);
  search(200, 3, {{"pairs", true}, {"count", std::string("cover")}}, false);
  search(200, 4, {{"neighbours", true}, {"median", true}}, false);
  search(200, 5,
         {{"bound", std::string("tight")},
          {"pairs", true},
          {"count", std::string("cover")},
          {"neighbours", true},
          {"median", true}},
         false);
}

TEST_CASE("the same on links that lose and delay messages: 300 loops") {
  search(150, 6, {}, true);
  search(150, 7, {{"pairs", true}, {"count", std::string("cover")}, {"neighbours", true}, {"median", true}},
         true);
}

TEST_CASE(
    "the same where vehicles are replaced, messages are lost and measurements are missing: 1200 strings") {
  test::Rng rng(9);
  const char* const laws[] = {"uniform", "extreme", "one_sided", "none"};
  int bounds = 0;
  int accusations = 0;
  for (int run = 0; run < 1200; ++run) {
    const auto p = test::random_platoon(rng);
    const auto victims = test::random_victims(rng, p.setting);
    const auto start = test::random_start(rng, p.setting);
    ParamMap params = p.params;
    if (run % 2 == 1) {
      params["bound"] = std::string("tight");
      params["count"] = std::string("cover");
      for (const char* name : {"pairs", "neighbours", "median"}) params[name] = true;
    }
    test::StringByHand string(p, params, start, static_cast<std::uint64_t>(run), laws[run % 4]);
    string.attack(test::random_attack(rng, p.setting, victims));
    const double loss = run % 3 == 0 ? 0.0 : test::uniform(rng, 0.0, 0.5);
    const double missing = run % 5 < 3 ? 0.0 : test::uniform(rng, 0.0, 0.3);
    test::Promises kept;
    for (int t = 0; t <= 40; ++t) {
      string.step(t, loss, missing);
      string.judge(victims, kept);
      for (int i = 0; i < string.N(); ++i) {
        bounds += std::isnan(string.bound(i)) ? 0 : 1;
        accusations += string.state(i).sets.attacked.count();
      }
      if (run % 2 == 0 && t % 9 == 4)
        string.replace(test::whole(rng, 0, string.N() - 1), Vec<2>(test::uniform(rng, -1e3, 1e3), 0.0));
    }
    CAPTURE(run);
    CAPTURE(loss);
    CAPTURE(victims.size());
    CHECK(kept.bounds_violated == 0);
    CHECK(kept.gaps_violated == 0);
    CHECK(kept.accused_clean == 0);
    CHECK(kept.cleared_attacked == 0);
    CHECK(kept.doubted == 0);
  }
  CHECK(bounds > 300000);
  CHECK(accusations > 50000);
}

TEST_CASE(
    "the printed bound is violated in random loops (E1, E2 of docs/filters/platoon.md) and never reported") {
  test::Rng rng(8);
  int violated = 0;
  for (int run = 0; run < 200; ++run) {
    const auto p = test::random_platoon(rng);
    const auto victims = test::random_victims(rng, p.setting);
    ParamMap params = p.params;
    params["bound"] = std::string("printed");
    const auto start = test::random_start(rng, p.setting);
    RunOptions o = options(start, static_cast<std::uint64_t>(run));
    o.attacks = test::random_attack(rng, p.setting, victims);
    const PlantOptions plant{35, start.x0, 0.0, "extreme", {}};
    const Record r = simulate(p.model, p.network, *make_filter("platoon", params), plant, o);
    const auto N = static_cast<std::size_t>(r.agents);
    bool wrong = false;
    for (std::size_t t = 0; t <= 35; ++t)
      for (std::size_t i = 0; i < N; ++i) {
        CHECK(std::isnan(r.bound[t * N + i]));
        wrong = wrong || r.error[t * N + i] > r.signals[t * N * r.signal_names.size() + i] + 1e-9;
      }
    violated += wrong ? 1 : 0;
  }
  CHECK(violated > 0);
}

TEST_CASE("more attackers than assumed are noticed, and no bound is reported then") {
  int noticed = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    test::Rng rng(100 + seed);
    const auto p = test::random_platoon(rng);
    std::vector<int> victims;
    for (int i = 0; i <= p.setting.attacked; ++i) victims.push_back(i);
    const auto start = test::random_start(rng, p.setting);
    RunOptions o = options(start, seed);
    o.attacks = {random_noise(Schedule(1, victims), "normal", 1e4, false)};
    const PlantOptions plant{20, start.x0, 0.0, "uniform", {}};
    ParamMap params = p.params;
    params["pairs"] = true;
    const Record r = simulate(p.model, p.network, *make_filter("platoon", params), plant, o);
    const auto N = static_cast<std::size_t>(r.agents);
    bool any = false;
    for (std::size_t i = 0; i < N; ++i) {
      const bool trouble = r.signals[20 * N * r.signal_names.size() + 6 * N + i] != 0.0;
      any = any || trouble;
      if (trouble) CHECK(std::isnan(r.bound[20 * N + i]));
    }
    noticed += any ? 1 : 0;
  }
  CHECK(noticed >= 35);
}
