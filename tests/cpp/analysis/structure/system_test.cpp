// SPDX-License-Identifier: Apache-2.0
// Classes, necessary agents and substitutes against their definitions.
#include <doctest/doctest.h>

#include "garrison/analysis/structure/strong_subgraph.hpp"
#include "garrison/analysis/structure/substitution.hpp"
#include "random_pattern.hpp"

using namespace garrison;
using namespace garrison::structure;

namespace {

Sensors single(const std::vector<int>& measured) {
  Sensors all;
  for (const int s : measured) all.push_back({s});
  return all;
}

/// Structural observability by its definition: paths from every state, and Kuhn's rank of [A; C].
bool observable_slowly(const Pattern& p, const Sensors& sensors) {
  const int n = p.columns();
  std::vector<char> ok(static_cast<std::size_t>(n), 0);
  for (const auto& list : sensors)
    for (const int s : list) ok[static_cast<std::size_t>(s)] = 1;
  for (int round = 0; round < n; ++round)
    for (int j = 0; j < n; ++j)
      for (const int i : p.column(j))
        if (ok[static_cast<std::size_t>(i)] != 0) ok[static_cast<std::size_t>(j)] = 1;
  if (std::find(ok.begin(), ok.end(), 0) != ok.end()) return false;
  return test::kuhn_size(p.stacked(sensors)) == n;
}

}  // namespace

TEST_CASE("observability, necessary agents and substitutes are those of the definitions") {
  test::Rng rng(21);
  int observable_cases = 0;
  for (int k = 0; k < 400; ++k) {
    const int n = test::whole(rng, 1, 9);
    const Pattern p = test::random_pattern(rng, n, n, test::whole(rng, n / 2, 3 * n));
    std::vector<int> measured;
    for (int i = test::whole(rng, 1, 5); i > 0; --i) measured.push_back(test::whole(rng, 0, n - 1));
    const Sensors sensors = single(measured);
    const System system(p);
    const bool observable = observable_slowly(p, sensors);
    observable_cases += observable ? 1 : 0;
    CAPTURE(k);
    CHECK(system.observability(sensors).holds() == observable);
    const auto necessary = system.necessary(sensors);
    const auto substitutes = system.substitutes(sensors);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      Sensors other = sensors;
      other[i].clear();
      CHECK((necessary[i] != 0) == (observable && !observable_slowly(p, other)));
      std::vector<int> exact;
      for (int s = 0; s < n; ++s) {
        if (s == measured[i]) continue;
        other[i] = {s};
        if (observable_slowly(p, other)) exact.push_back(s);
      }
      CHECK(substitutes[i] == exact);
    }
  }
  CHECK(observable_cases > 50);
}

TEST_CASE("the contraction of a measured state holds all valid substitutes of a necessary alpha agent") {
  test::Rng rng(22);
  int cases = 0;
  for (int k = 0; k < 1500 && cases < 200; ++k) {
    const int n = test::whole(rng, 2, 9);
    const Pattern p = test::random_pattern(rng, n, n, test::whole(rng, n, 2 * n));
    const System system(p);
    std::vector<int> measured;
    for (int i = test::whole(rng, 1, 4); i > 0; --i) measured.push_back(test::whole(rng, 0, n - 1));
    const Sensors sensors = single(measured);
    const auto contractions = system.contraction_of_measured(sensors);
    if (contractions.empty() || !system.observability(sensors).holds()) continue;
    const auto substitutes = system.substitutes(sensors);
    const auto types = system.classes(sensors);
    for (std::size_t i = 0; i < measured.size(); ++i) {
      if (types[i] != AgentClass::alpha) continue;
      ++cases;
      const auto& contraction = contractions.at(measured[i]);
      for (const int s : substitutes[i]) CHECK(std::binary_search(contraction.begin(), contraction.end(), s));
    }
  }
  CHECK(cases > 100);
}

TEST_CASE("mitigation one at a time never loses an observability that some choice keeps") {
  test::Rng rng(23);
  int replaced = 0;
  for (int k = 0; k < 400; ++k) {
    const int n = test::whole(rng, 2, 9);
    const Pattern p = test::random_pattern(rng, n, n, test::whole(rng, n, 3 * n));
    const System system(p);
    std::vector<int> measured;
    for (int i = test::whole(rng, 2, 4); i > 0; --i) measured.push_back(test::whole(rng, 0, n - 1));
    if (!system.observability(single(measured)).holds()) continue;
    const auto types = system.classes(single(measured));
    const std::vector<int> alarms{0, 1};
    const auto done = mitigate(system, measured, types, alarms, Choice::exact, Matrix());
    Sensors now;
    for (const int s : done.measured) now.push_back(s < 0 ? std::vector<int>{} : std::vector{s});
    for (const auto& line : done.log) {
      CHECK(line.before == measured[static_cast<std::size_t>(line.agent)]);
      if (line.after >= 0) {
        ++replaced;
        CHECK(std::count(measured.begin(), measured.end(), line.after) == 0);
      }
    }
    // Every necessary agent that found a substitute left the system observable.
    const auto needed = system.necessary(single(measured));
    const bool found = std::all_of(done.log.begin(), done.log.end(), [&](const Substitution& l) {
      return l.after >= 0 || needed[static_cast<std::size_t>(l.agent)] == 0;
    });
    if (found && done.log.size() == 1) CHECK(system.observability(now).holds());
  }
  CHECK(replaced > 20);
}

TEST_CASE("two substitutions at once can fail where one at a time cannot (docs/filters/structural.md#d3)") {
  const std::vector<std::pair<int, int>> edges{{0, 1}, {1, 2}, {2, 0}, {1, 0}, {3, 6}, {3, 2},
                                               {4, 5}, {5, 5}, {5, 3}, {6, 8}, {6, 9}, {6, 1},
                                               {7, 3}, {8, 7}, {8, 4}, {9, 3}};
  const System system(Pattern(10, 10, edges));
  const std::vector<int> measured{0, 5, 6, 9};
  const auto substitutes = system.substitutes(single(measured));
  CHECK(substitutes[1] == std::vector{4, 7});
  CHECK(substitutes[3] == std::vector{7});
  CHECK_FALSE(system.observability(single({0, 7, 6, 7})).holds());
  const auto done = mitigate(system, measured, system.classes(single(measured)), std::vector{1, 3},
                             Choice::exact, Matrix());
  CHECK(done.measured == std::vector{0, 4, 6, 7});
}

TEST_CASE("cheapest sensors and networks agree with enumeration") {
  test::Rng rng(24);
  int found_some = 0;
  for (int k = 0; k < 150; ++k) {
    const int n = test::whole(rng, 1, 5);
    const int agents = test::whole(rng, 1, 3);
    const Pattern p = test::random_pattern(rng, n, n, test::whole(rng, 0, 2 * n));
    const Matrix cost =
        Matrix::NullaryExpr(agents, n, [&] { return static_cast<double>(test::whole(rng, 0, 9)); });
    double best = kInfinity;
    std::vector<int> choice(static_cast<std::size_t>(agents), -1);
    const auto enumerate = [&](const auto& self, std::size_t a, double sum) -> void {
      if (a == choice.size()) {
        Sensors s;
        for (const int c : choice) s.push_back(c < 0 ? std::vector<int>{} : std::vector{c});
        if (test::kuhn_size(p.stacked(s)) == n) best = std::min(best, sum);
        return;
      }
      for (int s = -1; s < n; ++s) {
        choice[a] = s;
        self(self, a + 1, sum + (s < 0 ? 0.0 : cost(static_cast<Eigen::Index>(a), s)));
      }
    };
    enumerate(enumerate, 0, 0.0);
    const Picks picks = cheapest_rank_sensors(p, cost);
    CHECK(picks.exists == std::isfinite(best));
    if (picks.exists) CHECK(picks.cost == doctest::Approx(best));
    found_some += picks.exists && best > 0.0 ? 1 : 0;
  }
  CHECK(found_some > 20);

  int strong = 0;
  for (int k = 0; k < 120; ++k) {
    const int N = test::whole(rng, 1, 5);
    std::vector<std::pair<int, int>> edges;
    for (int a = 0; a < N; ++a)
      for (int b = 0; b < N; ++b)
        if (a != b && test::uniform(rng, 0, 1) < 0.6 && edges.size() < 12) edges.emplace_back(a, b);
    std::vector<double> weights;
    for (std::size_t e = 0; e < edges.size(); ++e) weights.push_back(test::whole(rng, 0, 20));
    double best = kInfinity;
    for (unsigned mask = 0; mask < (1U << edges.size()); ++mask) {
      std::vector<std::pair<int, int>> kept;
      double sum = 0.0;
      for (std::size_t e = 0; e < edges.size(); ++e)
        if ((mask >> e & 1U) != 0) {
          kept.push_back(edges[e]);
          sum += weights[e];
        }
      if (sum < best && strong_components(Pattern(N, N, kept)).count == 1) best = sum;
    }
    const auto found = cheapest_strong_subgraph(N, edges, weights);
    CHECK(found.exists == std::isfinite(best));
    if (!found.exists) continue;
    ++strong;
    CHECK(found.exact);
    CHECK(found.cost == doctest::Approx(best));
    // Stopped at once, what is left is the heuristic with its bounds.
    const auto quick = cheapest_strong_subgraph(N, edges, weights, 1);
    CHECK(quick.lower_bound <= best + 1e-9);
    CHECK(quick.cost >= best - 1e-9);
    CHECK(quick.cost <= 2.0 * best + 1e-9);
  }
  CHECK(strong > 40);
}

TEST_CASE("the structural analysis refuses what does not exist") {
  const System system(Pattern(2, 2, std::vector<std::pair<int, int>>{{0, 1}, {1, 0}}));
  CHECK_THROWS_WITH_AS(system.classes(Sensors{{0}, {2}}),
                       doctest::Contains("measured state of agent 1: got 2"), InvalidInput);
  CHECK_THROWS_WITH_AS(system.class_candidates(std::vector{0, 2}, 0, AgentClass::alpha),
                       doctest::Contains("measured state of agent 1: got 2"), InvalidInput);
  CHECK_THROWS_WITH_AS(system.class_candidates(std::vector{0}, 1, AgentClass::alpha),
                       doctest::Contains("agent: got 1"), InvalidInput);
  const std::vector<AgentClass> types{AgentClass::beta};
  CHECK_THROWS_WITH_AS(mitigate(system, std::vector{0}, types, std::vector{1}, Choice::exact, Matrix()),
                       doctest::Contains("alarms: got 1"), InvalidInput);
  CHECK_THROWS_AS(System(Pattern(0, 0, {})), InvalidInput);
  CHECK_THROWS_WITH_AS(cheapest_rank_sensors(system.pattern(), Matrix::Constant(1, 2, -1.0)),
                       doctest::Contains("cost"), InvalidInput);
  CHECK_THROWS_AS(cheapest_strong_subgraph(2, std::vector<std::pair<int, int>>{{0, 1}}, std::vector{-1.0}),
                  InvalidInput);
}
