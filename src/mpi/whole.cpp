// SPDX-License-Identifier: Apache-2.0
#include "mpi/whole.hpp"

#include <mpi.h>

#include <cinttypes>
#include <cstdio>
#include <numeric>

#include "garrison/engine/any_filter.hpp"
#include "mpi/hash.hpp"
#include "mpi/memory.hpp"
#include "mpi/scenario.hpp"

namespace garrison::mpi {

void run_whole(const std::string& path, int threads) {
  const Scenario s = read_scenario(path, kWhole);
  std::vector<int> all(static_cast<std::size_t>(s.agents()));
  std::iota(all.begin(), all.end(), 0);
  RunOptions options = s.run;
  options.threads = threads;
  options.keep = {.estimate = true,
                  .report = false,
                  .signals = false,
                  .measurements = false,
                  .details = false,
                  .box = false};
  const double start = MPI_Wtime();
  const auto prepared =
      make_filter(s.family, s.params)->prepare(s.sensors.model(all), partition::network_of(*s.ground));
  const double designed = MPI_Wtime();
  const Record record = simulate(*prepared, s.plant, options);
  const double seconds = MPI_Wtime() - designed;
  const auto n = static_cast<std::size_t>(s.states());
  const auto N = all.size();
  std::uint64_t hash = 0;
  for (std::size_t t = 1; t <= static_cast<std::size_t>(s.plant.steps); ++t)
    for (std::size_t i = 0; i < N; ++i)
      hash += hash_of({record.estimate.data() + (t * N + i) * n, n}, static_cast<std::int64_t>(t),
                      static_cast<int>(i));
  std::printf("%zu agents, one engine, design %.3f s; %d samples in %.3f s, %.3f ms each; %.0f MB\n", N,
              designed - start, s.plant.steps, seconds, 1e3 * seconds / s.plant.steps, megabytes());
  std::printf("hash %016" PRIx64 "\n", hash);
}

}  // namespace garrison::mpi
