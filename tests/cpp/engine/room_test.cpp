// SPDX-License-Identifier: Apache-2.0
// What a part of a design claims beyond what is in it: refused before any memory is taken for it.
#include <doctest/doctest.h>

#include <algorithm>

#include "../random_system.hpp"
#include "garrison/engine/design_file.hpp"
#include "garrison/engine/part.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/wire/blake2b.hpp"

using namespace garrison;

namespace {

using Bytes = std::vector<std::byte>;

/// Ten agents that hear all others, in ten rounds; with the detector a message has a bit per agent.
std::shared_ptr<const Prepared> design(bool detector, std::int64_t rounds = 10) {
  test::Rng rng(3);
  ParamMap params{
      {"threshold", 0.5}, {"rounds", rounds}, {"attacked", std::int64_t{1}}, {"initial_error", 2.0}};
  if (detector) params["detector"] = true;
  return make_filter("saturation", params)
      ->prepare(test::scalar_model(rng, 2, 10, 1.02, 0.02, 0.1), Network::complete(10));
}

/// The part of agent 1, which claims to be one of so many, with the hash that belongs to it.
Bytes claiming(const Prepared& prepared, int agents) {
  Bytes file = write_part(prepared, 1);
  const Bytes part = prepared.part_bytes(1);
  const auto there = std::search(file.begin(), file.end(), part.begin(), part.end());
  REQUIRE(there != file.end());
  wire::store(&*there + 4, static_cast<std::uint32_t>(agents));  // behind the agent's id
  file.resize(file.size() - sizeof(wire::Digest));
  const wire::Digest digest = wire::blake2b(file);
  file.insert(file.end(), digest.begin(), digest.end());
  return file;
}

Refusal without_exceptions(const Bytes& file) {
  Refusal why = Refusal::none;
  const auto agent = agent_of_part<Saturation, 2>(file, why);
  CHECK((agent != nullptr) == (why == Refusal::none));
  return why;
}

}  // namespace

TEST_CASE("mailboxes that would take hundreds of megabytes are refused with what they would take") {
  const auto prepared = design(true);
  // 2 samples, 10 rounds, 9 neighbours, 8 MiB a message
  const Bytes file = claiming(*prepared, kMostAgents);
  CHECK_THROWS_WITH_AS(
      read_part(file),
      doctest::Contains("an agent of 67108864 whose mailboxes, for 9 neighbours and 10 rounds, "
                        "would take 1510 MB, expected at most 537 MB"),
      InvalidInput);
  CHECK(without_exceptions(file) == Refusal::size);
}

TEST_CASE("an agent of more than there can be is refused whatever it takes") {
  for (const bool detector : {false, true}) {
    const Bytes file = claiming(*design(detector), INT32_MAX);
    CHECK_THROWS_WITH_AS(read_part(file), doctest::Contains("an agent of 2147483647, expected at most"),
                         InvalidInput);
    CHECK(without_exceptions(file) == Refusal::size);
  }
}

TEST_CASE("many agents are no reason to refuse one that has room for what it hears") {
  CHECK(read_part(claiming(*design(true), 1'000'000))->agents() == 1'000'000);  // 23 MB
  CHECK(read_part(claiming(*design(false), kMostAgents))->most_bytes() < 100);  // keeps no set
  CHECK(without_exceptions(claiming(*design(true), 1'000'000)) == Refusal::none);
}

TEST_CASE("rounds that no agent has are refused in a part as in a design") {
  const auto prepared = design(false, 1001);
  CHECK_THROWS_WITH_AS(prepared->agent(1),
                       doctest::Contains("saturation.rounds: got 1001, expected at most 1000"), InvalidInput);
  const Bytes file = write_part(*prepared, 1);
  CHECK_THROWS_WITH_AS(read_part(file),
                       doctest::Contains("saturation.rounds: got 1001, expected at most 1000"), InvalidInput);
  CHECK(without_exceptions(file) == Refusal::size);
}
