// SPDX-License-Identifier: Apache-2.0
#include "mpi/owners.hpp"

#include "node/daemon/files.hpp"
#include "partition/split.hpp"

namespace garrison::mpi {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 34;

std::vector<std::int32_t> cached(const std::string& path, const Scenario& scenario, int ranks,
                                 const std::string& description) {
  try {
    return partition::partition_of(node::read_bytes(path, kMostBytes), scenario.agents(), ranks, description);
  } catch (const IoError&) {
    return {};  // there is none yet
  }
}

Owners made(const Scenario& scenario, int ranks) {
  const bool asked = scenario.method == "metis";
  if (asked && !has_metis())
    refuse("[partition].method", "\"metis\" in a build without METIS", "auto, coordinates or blocks",
           "or build with libmetis-dev installed");
  const bool wanted = asked || (scenario.method == "auto" && scenario.agents() <= kMostForMetis);
  std::string instead;
  if (wanted && has_metis()) {
    Owners out{metis_owners(*scenario.ground, ranks), "METIS"};
    const std::string why = out.of.empty() ? "METIS returned an error" : partition::unbalanced(out.of, ranks);
    if (why.empty()) return out;
    if (asked) partition::require_balanced("METIS", out.of, ranks);
    instead = ", because METIS left " + why;
  }
  if (scenario.method != "blocks") {
    Owners out{scenario.ground->owners(ranks), "coordinates" + instead};
    const std::string why = partition::unbalanced(out.of, ranks);
    if (why.empty()) return out;
    if (scenario.method == "coordinates") partition::require_balanced("coordinates", out.of, ranks);
    instead += ", because coordinates left " + why;
  }
  const auto blocks = partition::band(scenario.agents(), 1);  // blocks of ids whatever the network is
  return {blocks->owners(ranks), "blocks of ids" + instead};
}

}  // namespace

std::string cache_of(const Scenario& scenario, int ranks) {
  return scenario.path + "." + std::to_string(ranks) + ".partition";
}

Owners owners_of(const Scenario& scenario, int ranks) {
  if (ranks > scenario.agents())
    refuse("ranks", std::to_string(ranks), "at most " + std::to_string(scenario.agents()) + ", one per agent",
           "start fewer with mpirun -n");
  if (ranks == 1)
    return {std::vector<std::int32_t>(static_cast<std::size_t>(scenario.agents()), 0), "one rank"};
  const std::string path = cache_of(scenario, ranks);
  const std::string description = scenario.method + " " + scenario.ground->description();
  if (auto found = cached(path, scenario, ranks, description); !found.empty())
    return {std::move(found), path};
  Owners out = made(scenario, ranks);
  try {
    node::replace_file(path, partition::partition_bytes(out.of, ranks, description), 0644);
  } catch (const IoError& error) {
    out.not_kept = error.what();
  }
  return out;
}

}  // namespace garrison::mpi
