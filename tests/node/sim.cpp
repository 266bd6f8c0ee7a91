// SPDX-License-Identifier: Apache-2.0
// garrison_node_sim FIRST COUNT [all|cold|clock|liar|honest]: that many seeds of the simulation; ends with 1
// when anything did not hold.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "simulation.hpp"

using namespace garrison::node::test;

int main(int count, char** arguments) {
  const auto weather = weather_of(count == 4 ? arguments[3] : "all");
  if ((count != 3 && count != 4) || !weather || !garrison::node::start_crypto()) {
    std::fprintf(stderr, "usage: garrison_node_sim FIRST COUNT [all|cold|clock|liar|honest]\n");
    return 2;
  }
  const std::uint64_t first = std::strtoull(arguments[1], nullptr, 10);
  const std::uint64_t seeds = std::strtoull(arguments[2], nullptr, 10);
  Totals t;
  const std::clock_t before = std::clock();
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) Simulation(seed, t, true, *weather).run();
  const double cpu = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  const auto n = [](std::int64_t v) { return static_cast<long long>(v); };
  std::printf(
      "seeds %lld in %.1f s CPU, %.0f a minute; events %lld, %.2f us each; datagrams %lld, refused %lld\n",
      n(t.seeds), cpu, 60 * static_cast<double>(t.seeds) / cpu, n(t.events),
      1e6 * cpu / static_cast<double>(t.events), n(t.datagrams), n(t.refused));
  std::printf(
      "samples %lld, complete %lld; messages missing %lld, asked for %lld, sent again %lld; crashes %lld, "
      "joins %lld, "
      "clock steps %lld, contradictions seen %lld\n",
      n(t.samples), n(t.complete), n(t.missing), n(t.wants), n(t.resent), n(t.crashes), n(t.joins),
      n(t.clock_steps), n(t.conflicts));
  const auto row = [&](const char* what, std::int64_t checked, std::int64_t wrong) {
    std::printf("%-58s %12lld checked, %lld wrong\n", what, n(checked), n(wrong));
  };
  row("copied datagrams taken a second time", t.injected, t.taken_twice_wrong);
  row("mutated datagrams taken", t.mutated, t.mutants_wrong);
  row("fused bodies their sender did not produce for that round", t.fused, t.fused_wrong);
  row("rounds of a sample with two bodies of one node", t.bodies, t.bodies_wrong);
  row("estimates that are not finite", t.estimates, t.estimates_wrong);
  row("errors beyond the reported bound", t.bounds, t.bounds_wrong);
  row("samples in which an honest sensor is proved", t.proofs, t.proofs_wrong);
  row("statements of honest nodes that contradict something", t.statements, t.statements_wrong);
  std::printf("%-58s %12lld\n", "convictions of liars who signed two things", n(t.convictions));
  row("liars not proved by two nodes within three batches", t.equivocations, t.equivocations_wrong);
  row("clocks right again, but no complete sample in three", t.steps, t.steps_wrong);
  row("nodes not back with all links at the end", t.nodes, t.nodes_wrong);
  row("estimates that the log does not give again", t.replayed, t.replayed_wrong);
  row("estimates other than the plain loop's", t.plain, t.plain_wrong);
  return t.wrong() == 0 ? 0 : 1;
}
