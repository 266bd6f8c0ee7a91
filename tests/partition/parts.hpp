// SPDX-License-Identifier: Apache-2.0
// A model and a network cut into parts, as ranks get them.
#pragma once

#include <vector>

#include "fake_ranks.hpp"
#include "partition/families.hpp"
#include "partition/part_run.hpp"
#include "partition/split.hpp"
#include "random_system.hpp"

namespace garrison::test {

/// A rank for every agent; every rank has one.
inline std::vector<std::int32_t> random_owners(Rng& rng, int agents, int ranks) {
  std::vector<std::int32_t> owner;
  for (int i = 0; i < agents; ++i) owner.push_back(i < ranks ? i : whole(rng, 0, ranks - 1));
  return owner;
}

/// What rank `rank` has of a whole.
struct Part {
  std::vector<int> ids;
  partition::Region region;
  Model model;
};

inline Model model_of(const Model& all, std::span<const int> ids) {
  std::vector<Matrix> C;
  Noise noise = all.noise();
  noise.measurement_bound.resize(0);
  noise.measurement_covariance.clear();
  if (all.noise().measurement_bound.size() > 0)
    noise.measurement_bound.resize(static_cast<Eigen::Index>(ids.size()));
  for (std::size_t k = 0; k < ids.size(); ++k) {
    C.push_back(all.C(ids[k]));
    if (noise.measurement_bound.size() > 0)
      noise.measurement_bound(static_cast<Eigen::Index>(k)) = all.noise().measurement_bound(ids[k]);
    if (!all.noise().measurement_covariance.empty())
      noise.measurement_covariance.push_back(
          all.noise().measurement_covariance[static_cast<std::size_t>(ids[k])]);
  }
  return {all.A(), std::move(C), std::move(noise)};
}

inline Part part_of(const partition::Whole& whole, std::span<const std::int32_t> owner, int rank,
                    int halo = 1) {
  const std::vector<int> ids = partition::agents_of(owner, rank);
  const auto ground = partition::listed(whole.network);
  auto region = partition::region_of(
      whole.model.agents(), ids, [&](std::span<const int> some) { return ground->neighbours(some); }, owner,
      rank, halo);
  return {ids, std::move(region), model_of(whole.model, ids)};
}

/// Estimates of all samples 1..steps by time, public id and state, as a Record has them behind its start.
struct Estimates {
  std::vector<double> values;
  LinkCounters link;
  std::int64_t overflows = 0;
  std::int64_t resets = 0;
  std::vector<std::vector<std::byte>> states;  ///< by public id, at the end
};

inline Estimates run_parts(const partition::Whole& whole, const std::string& family, const ParamMap& params,
                           const PlantOptions& plant, const RunOptions& options,
                           std::span<const std::int32_t> owner, int ranks, bool by_rank = false,
                           int halo = 1) {
  const auto N = static_cast<std::size_t>(whole.model.agents());
  const auto n = static_cast<std::size_t>(whole.model.states());
  Estimates out;
  out.values.resize(static_cast<std::size_t>(plant.steps) * N * n);
  out.states.resize(N);
  std::vector<Estimates> counted(static_cast<std::size_t>(ranks));
  FakeWorld world(ranks);
  world.run([&](partition::Exchange& exchange) {
    const Part part = part_of(whole, owner, exchange.rank(), halo);
    const bool needs = !by_rank && !partition::needs_whole(family, params, whole.model.agents()).empty();
    const auto runner =
        partition::part_runner(family, params, needs ? &whole : nullptr, part.model, part.region, exchange);
    partition::PartRun run(*runner, part.model, part.ids, whole.model.agents(), plant, options);
    run.start();
    std::vector<double> here(part.ids.size() * n);
    for (std::size_t t = 0; t < static_cast<std::size_t>(plant.steps); ++t) {
      run.advance();
      runner->estimates(here.data());
      for (std::size_t k = 0; k < part.ids.size(); ++k)
        std::copy_n(here.data() + k * n, n,
                    out.values.data() + (t * N + static_cast<std::size_t>(part.ids[k])) * n);
    }
    for (std::size_t k = 0; k < part.ids.size(); ++k)
      runner->save(static_cast<int>(k), out.states[static_cast<std::size_t>(part.ids[k])]);
    counted[static_cast<std::size_t>(exchange.rank())] = {
        {}, run.link(), runner->overflows(), runner->resets(), {}};
  });
  for (const Estimates& one : counted) {
    out.link += one.link;
    out.overflows = std::max(out.overflows, one.overflows);
    out.resets += one.resets;
  }
  return out;
}

}  // namespace garrison::test
