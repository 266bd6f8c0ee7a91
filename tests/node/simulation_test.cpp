// SPDX-License-Identifier: Apache-2.0
#include "simulation.hpp"

#include <doctest/doctest.h>

using namespace garrison::node::test;

TEST_CASE("300 seeds of faults: what must hold holds") {
  Totals totals;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) Simulation(seed, totals).run();
  CHECK(totals.taken_twice_wrong == 0);
  CHECK(totals.mutants_wrong == 0);
  CHECK(totals.fused_wrong == 0);
  CHECK(totals.bodies_wrong == 0);
  CHECK(totals.estimates_wrong == 0);
  CHECK(totals.bounds_wrong == 0);
  CHECK(totals.proofs_wrong == 0);
  CHECK(totals.statements_wrong == 0);
  CHECK(totals.nodes_wrong == 0);
  CHECK(totals.replayed_wrong == 0);
  CHECK(totals.plain_wrong == 0);
  CHECK(totals.convictions > 10);
  // Every kind of fault and of comparison took place.
  for (const std::int64_t seen :
       {totals.injected, totals.mutated, totals.conflicts, totals.crashes, totals.joins, totals.clock_steps,
        totals.resent, totals.bounds, totals.proofs, totals.fused, totals.statements, totals.replayed,
        totals.plain})
    CHECK(seen > 100);
}

TEST_CASE("weathers of their own: cold restarts, clocks an hour off, liars, and honest ones who sign") {
  const auto run = [](Weather weather) {
    Totals totals;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) Simulation(seed, totals, false, weather).run();
    CHECK(totals.wrong() == 0);
    return totals;
  };
  const Totals cold = run(Weather::cold);
  CHECK(cold.crashes >= 40);
  CHECK(cold.joins >= 40);
  CHECK(cold.proofs > 1000);
  const Totals hours = run(Weather::clock);
  CHECK(hours.clock_steps >= 80);
  CHECK(hours.steps == 40);
  const Totals liars = run(Weather::liar);
  CHECK(liars.equivocations == 40);
  CHECK(liars.convictions >= 80);
  const Totals honest = run(Weather::honest);
  CHECK(honest.convictions == 0);
  CHECK(honest.statements > 1000);
}

// A clock that goes back while the node listens: it stayed in a loop, or ahead of everybody. 2114: ends with
// different sessions, of which one was heard and the other was not.
TEST_CASE("seeds that went wrong before") {
  Totals totals;
  for (const std::uint64_t seed : {2114, 3825, 5763, 6759, 8924}) Simulation(seed, totals).run();
  CHECK(totals.wrong() == 0);
}

TEST_CASE("the same seed is the same run") {
  Totals a, b;
  Simulation(17, a).run();
  Simulation(17, b).run();
  CHECK(a.events == b.events);
  CHECK(a.datagrams == b.datagrams);
  CHECK(a.refused == b.refused);
  CHECK(a.fused == b.fused);
}
