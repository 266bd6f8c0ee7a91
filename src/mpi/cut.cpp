// SPDX-License-Identifier: Apache-2.0
#include "mpi/cut.hpp"

#include <cstdio>
#include <span>

#include "mpi/owners.hpp"
#include "mpi/together.hpp"
#include "partition/split.hpp"

namespace garrison::mpi {

Cut cut_of(const Scenario& scenario, MpiExchange& exchange, int depth) {
  Owners owners;
  together([&] {
    if (exchange.rank() == 0) owners = owners_of(scenario, exchange.ranks());
  });
  owners.of.resize(static_cast<std::size_t>(scenario.agents()));
  MPI_Bcast(owners.of.data(), scenario.agents(), MPI_INT32_T, 0, MPI_COMM_WORLD);
  Cut cut;
  cut.made = owners.made + (owners.not_kept.empty() ? "" : ", not kept: " + owners.not_kept);
  together([&] {
    cut.ids = partition::agents_of(owners.of, exchange.rank());
    cut.region = partition::region_of(
        scenario.agents(), cut.ids,
        [&](std::span<const int> ids) { return scenario.ground->neighbours(ids); }, owners.of,
        exchange.rank(), depth);
  });
  return cut;
}

void say_cut(const partition::Region& region, MpiExchange& exchange, const std::string& made) {
  std::int64_t counts[] = {region.ghosts(),
                           static_cast<std::int64_t>(region.first[static_cast<std::size_t>(region.own)])};
  double most[] = {static_cast<double>(region.own)};
  exchange.sum(counts);
  exchange.largest(most);
  if (exchange.rank() != 0) return;
  std::printf("%d agents, %.1f neighbours each; ", region.agents,
              static_cast<double>(counts[1]) / region.agents);
  if (exchange.ranks() == 1)
    std::printf("one rank\n");
  else
    std::printf("%d ranks (%s): at most %.0f agents on one, ghosts %.3f %%\n", exchange.ranks(), made.c_str(),
                most[0], 100.0 * static_cast<double>(counts[0]) / region.agents);
  std::fflush(stdout);
}

}  // namespace garrison::mpi
