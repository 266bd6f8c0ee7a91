// SPDX-License-Identifier: Apache-2.0
// lambda_2 and lambda_max of networks that no rank holds.
#include "partition/spectrum.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <mutex>

#include "parts.hpp"

using namespace garrison;
using namespace garrison::partition;

namespace {

Spectrum spectrum_of(const Network& network, std::span<const std::int32_t> owner, int ranks, int most) {
  const auto ground = listed(network);
  std::vector<Spectrum> all(static_cast<std::size_t>(ranks));
  test::FakeWorld world(ranks);
  world.run([&](Exchange& exchange) {
    const std::vector<int> ids = agents_of(owner, exchange.rank());
    const Region region = region_of(
        network.agents(), ids, [&](std::span<const int> some) { return ground->neighbours(some); }, owner,
        exchange.rank());
    all[static_cast<std::size_t>(exchange.rank())] = laplacian_spectrum(region, exchange, most);
  });
  for (const Spectrum& one : all) {
    CHECK(std::bit_cast<std::uint64_t>(one.lambda2) == std::bit_cast<std::uint64_t>(all[0].lambda2));
    CHECK(one.products == all[0].products);
  }
  return all[0];
}

}  // namespace

TEST_CASE("the spectrum by products is that of the whole, with the same bits on any ranks") {
  test::Rng rng(20261130);
  for (int system = 0; system < 40; ++system) {
    const int agents = test::whole(rng, 2, 300);
    const Network network = system % 3 == 0   ? Network::ring(agents)
                            : system % 3 == 1 ? Network::random_geometric(agents, 0.3, system)
                                              : Network::band(agents, test::whole(rng, 1, 5));
    CAPTURE(system);
    CAPTURE(agents);
    if (!network.connected()) continue;
    const LaplacianSpectrum expected = network.laplacian_spectrum();
    const std::vector<std::int32_t> one(static_cast<std::size_t>(agents), 0);
    const Spectrum alone = spectrum_of(network, one, 1, 5000);
    CHECK(alone.settled);
    CHECK(alone.lambda2 >= expected.lambda2 * (1.0 - 1e-9));
    CHECK(alone.lambda2 <= expected.lambda2 * (1.0 + 1e-3));
    CHECK(alone.lambda_max <= expected.lambda_max * (1.0 + 1e-12));
    CHECK(alone.lambda_max >= expected.lambda_max * (1.0 - 1e-3));
    CHECK(alone.bound >= expected.lambda_max * (1.0 - 1e-12));
    for (const int ranks : {2, 3}) {
      if (agents < ranks) continue;
      const Spectrum parts = spectrum_of(network, test::random_owners(rng, agents, ranks), ranks, 5000);
      CHECK(std::bit_cast<std::uint64_t>(parts.lambda2) == std::bit_cast<std::uint64_t>(alone.lambda2));
      CHECK(std::bit_cast<std::uint64_t>(parts.lambda_max) == std::bit_cast<std::uint64_t>(alone.lambda_max));
    }
  }
}

TEST_CASE("too few products say that nothing has settled, and stay inside") {
  const Network network = Network::path(2000);
  const LaplacianSpectrum expected = network.laplacian_spectrum();
  const std::vector<std::int32_t> one(2000, 0);
  const Spectrum s = spectrum_of(network, one, 1, 40);
  CHECK_FALSE(s.settled);
  CHECK(s.products == 40);
  CHECK(s.lambda2 > expected.lambda2);
  CHECK(s.lambda_max <= expected.lambda_max * (1.0 + 1e-12));
}
