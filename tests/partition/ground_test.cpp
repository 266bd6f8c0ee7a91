// SPDX-License-Identifier: Apache-2.0
// Generated networks, partitions and regions.
#include "partition/ground.hpp"

#include <doctest/doctest.h>

#include <numeric>

#include "partition/connected.hpp"
#include "partition/sensors.hpp"
#include "partition/split.hpp"
#include "parts.hpp"

using namespace garrison;
using namespace garrison::partition;

TEST_CASE("networks generated agent by agent are those of Network") {
  CHECK(network_of(*band(9, 3)) == Network::band(9, 3));
  CHECK(network_of(*band(5, 9)) == Network::complete(5));
  for (const int agents : {1, 2, 3, 8}) CHECK(network_of(*ring(agents)) == Network::ring(agents));
  CHECK(network_of(*grid(4, 7)) == Network::grid(4, 7));
  CHECK(network_of(*grid(1, 3)) == Network::grid(1, 3));
  for (const double radius : {1e-300, 0.01, 0.08, 0.3, 2.0}) {
    CAPTURE(radius);
    CHECK(network_of(*random_geometric(300, radius, 4)) == Network::random_geometric(300, radius, 4));
  }
  const Network given = Network::star(6);
  CHECK(network_of(*listed(given)) == given);
  const std::vector<Edge> one{{0, 1}};
  CHECK_THROWS_WITH_AS(listed(Network(2, one, true)), doctest::Contains("undirected"), InvalidInput);
}

TEST_CASE("lists of some agents are those of all, and sensors too") {
  const auto ground = random_geometric(200, 0.1, 1);
  const Network all = network_of(*ground);
  Sensors sensors;
  sensors.A = Matrix::Identity(3, 3);
  sensors.seed = 5;
  sensors.measurement_bound = 0.1;
  std::vector<int> everyone(200);
  std::iota(everyone.begin(), everyone.end(), 0);
  const Model whole = sensors.model(everyone);
  const std::vector<int> some{3, 50, 51, 199};
  const Neighbours lists = ground->neighbours(some);
  const Model part = sensors.model(some);
  for (std::size_t k = 0; k < some.size(); ++k) {
    const auto expected = all.neighbours(some[k]);
    const auto got = lists.of(k);
    CHECK(std::equal(got.begin(), got.end(), expected.begin(), expected.end()));
    CHECK(part.C(static_cast<int>(k)) == whole.C(some[k]));
    CHECK(part.C(static_cast<int>(k)).norm() == doctest::Approx(1.0));
  }
}

TEST_CASE("sensors that are read have the rows, bounds and covariances of the agents that are asked for") {
  struct Tens final : Column {
    explicit Tens(int each) : width(each) {}
    std::vector<double> of(std::span<const int> ids) const override {
      std::vector<double> out;
      for (const int id : ids)
        for (int c = 0; c < width; ++c) out.push_back(10.0 * id + c + 1.0);
      return out;
    }
    int width;
  };
  Sensors sensors;
  sensors.A = Matrix::Identity(2, 2);
  sensors.rows_read = std::make_shared<Tens>(2);
  sensors.bounds_read = std::make_shared<Tens>(1);
  sensors.variances_read = std::make_shared<Tens>(1);
  const std::vector<int> some{3, 8};
  const Model model = sensors.model(some);
  CHECK(model.C(1) == (Matrix(1, 2) << 81.0, 82.0).finished());
  CHECK(model.noise().measurement_bound == (Vector(2) << 31.0, 81.0).finished());
  CHECK(model.noise().measurement_covariance[0](0, 0) == 31.0);
}

TEST_CASE("coordinates and blocks give every rank its share, near each other") {
  const auto ground = random_geometric(4000, 0.03, 1);
  std::vector<std::int32_t> blocks(4000);
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] = static_cast<std::int32_t>(i / 1000);
  const auto cut = [&](const std::vector<std::int32_t>& owner) {
    const Network network = network_of(*ground);
    std::int64_t links = 0;
    for (int i = 0; i < 4000; ++i)
      for (const int j : network.neighbours(i))
        links += owner[static_cast<std::size_t>(i)] != owner[static_cast<std::size_t>(j)] ? 1 : 0;
    return links;
  };
  const auto strips = ground->owners(4);
  CHECK(unbalanced(strips, 4).empty());
  CHECK(5 * cut(strips) < cut(blocks));
  CHECK(grid(10, 10)->owners(4) == band(100, 2)->owners(4));
}

TEST_CASE("a partition that leaves a rank without work is refused") {
  const std::vector<std::int32_t> good{0, 0, 1, 1, 2, 2};
  CHECK(unbalanced(good, 3).empty());
  CHECK(unbalanced(good, 4) == "no agent on rank 3");
  CHECK(unbalanced(std::vector<std::int32_t>{0, 1, 5}, 3) == "an agent on rank 5");
  std::vector<std::int32_t> crowded(100, 0);
  crowded[99] = 1;
  CHECK_THROWS_WITH_AS(require_balanced("METIS", crowded, 2), doctest::Contains("99 agents on rank 0 of 2"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(require_balanced("METIS", std::vector<std::int32_t>{0, 1}, 3),
                       doctest::Contains("fewer ranks"), InvalidInput);
  // 3 * 1.2 + 1, where the mean is no whole number either: 7 / 2.
  CHECK_THROWS_WITH_AS(require_balanced("METIS", std::vector<std::int32_t>{0, 0, 0, 0, 0, 0, 1}, 2),
                       doctest::Contains("expected 1 to 5 agents on every rank"), InvalidInput);
}

TEST_CASE("a cached partition is taken for its own ground, ranks and bytes only") {
  const std::vector<std::int32_t> owner{0, 1, 1, 0};
  const auto bytes = partition_bytes(owner, 2, "ring 4");
  CHECK(partition_of(bytes, 4, 2, "ring 4") == owner);
  CHECK(partition_of(bytes, 4, 2, "ring 5").empty());
  CHECK(partition_of(bytes, 4, 3, "ring 4").empty());
  CHECK(partition_of(bytes, 5, 2, "ring 4").empty());
  for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    CHECK(partition_of(std::span(bytes).first(cut), 4, 2, "ring 4").empty());
  auto damaged = bytes;
  damaged[bytes.size() / 2] ^= std::byte{1};
  CHECK(partition_of(damaged, 4, 2, "ring 4").empty());
}

TEST_CASE("a region: interior hears own agents only, ghosts lie as their owners send them") {
  test::Rng rng(8);
  const Whole whole{test::scalar_model(rng, 2, 30, 0.9, 0.0, 0.0), test::connected_network(rng, 30, 0.1)};
  const auto owner = test::random_owners(rng, 30, 3);
  std::vector<test::Part> parts;
  for (int rank = 0; rank < 3; ++rank) parts.push_back(test::part_of(whole, owner, rank));
  for (int rank = 0; rank < 3; ++rank) {
    const Region& r = parts[static_cast<std::size_t>(rank)].region;
    for (int place = 0; place < r.own; ++place) {
      const auto expected = whole.network.neighbours(r.ids[static_cast<std::size_t>(place)]);
      REQUIRE(static_cast<std::size_t>(r.degree(place)) == expected.size());
      bool ghosts = false;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const auto heard = r.heard[r.first[static_cast<std::size_t>(place)] + k];
        CHECK(r.ids[static_cast<std::size_t>(heard)] == expected[k]);
        ghosts = ghosts || heard >= r.own;
      }
      CHECK(ghosts == (place >= r.interior));
    }
    // What peer p receives from here, in its order, is what is packed here for p.
    std::size_t at = 0;
    for (std::size_t p = 0; p < r.routes.peers.size(); ++p) {
      const Region& other = parts[static_cast<std::size_t>(r.routes.peers[p])].region;
      std::vector<int> wanted;
      for (int place = other.own; place < other.places(); ++place)
        if (owner[static_cast<std::size_t>(other.ids[static_cast<std::size_t>(place)])] == rank)
          wanted.push_back(other.ids[static_cast<std::size_t>(place)]);
      REQUIRE(static_cast<int>(wanted.size()) == r.routes.sends[p]);
      for (const int id : wanted) CHECK(r.ids[static_cast<std::size_t>(r.packed[at++])] == id);
    }
    CHECK(at == r.packed.size());
  }
  const Lists nothing = [](std::span<const int>) { return Neighbours(); };
  CHECK_THROWS_WITH_AS(region_of(3, {}, nothing, std::vector<std::int32_t>{0, 0, 0}, 1),
                       doctest::Contains("no agent on rank 1"), InvalidInput);
}

TEST_CASE("a network that is not connected is found by all ranks, a chain through all of them too") {
  test::Rng rng(4);
  Sensors sensors;
  sensors.A = Matrix::Identity(2, 2);
  std::vector<int> all(40);
  std::iota(all.begin(), all.end(), 0);
  const Model model = sensors.model(all);
  const auto refusal = [&](const Network& network, int ranks) -> std::string {
    const Whole whole{model, network};
    const auto owner = test::random_owners(rng, 40, ranks);
    std::string words = "connected";
    test::FakeWorld world(ranks);
    try {
      world.run([&](Exchange& exchange) {
        require_connected(test::part_of(whole, owner, exchange.rank()).region, exchange);
      });
    } catch (const InvalidInput& error) {
      words = error.what();
    }
    return words;
  };
  std::vector<Edge> last_alone;
  for (int i = 0; i + 2 < 40; ++i) last_alone.emplace_back(i, i + 1);
  std::vector<Edge> cut;
  for (int i = 0; i + 1 < 40; ++i)
    if (i != 16) cut.emplace_back(i, i + 1);
  for (const int ranks : {1, 2, 5}) {
    CAPTURE(ranks);
    CHECK(refusal(Network::path(40), ranks) == "connected");
    const std::string words = refusal(Network(40, cut), ranks);
    CHECK(words.find("no path joins agent 0 and agent 17, nor 22 more") != std::string::npos);
    const std::string alone = refusal(Network(40, last_alone), ranks);
    CHECK(alone.find("no path joins agent 0 and agent 39") != std::string::npos);
    CHECK(alone.find("nor") == std::string::npos);
  }
}
