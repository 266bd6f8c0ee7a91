// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/plan/ordering.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../random_system.hpp"
#include "garrison/engine/plan/consensus.hpp"

using namespace garrison;

namespace {

std::vector<int> order_of(const Network& net) { return reverse_cuthill_mckee(net.offsets(), net.lists()); }

int bandwidth(const Network& net, const std::vector<int>& order) {
  std::vector<int> position(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    position[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  int most = 0;
  for (const auto& [a, b] : net.edges())
    most = std::max(most,
                    std::abs(position[static_cast<std::size_t>(a)] - position[static_cast<std::size_t>(b)]));
  return most;
}

}  // namespace

TEST_CASE("the order is a permutation, the same every time, also with isolated agents") {
  const std::vector<Edge> few{{0, 3}, {3, 4}};
  const std::vector<Edge> one_way{{0, 1}, {2, 1}, {4, 0}};
  for (const Network& net : {Network::complete(1), Network(7, few), Network(5, one_way, true),
                             Network::star(50), Network::ring(31), Network::grid(9, 14),
                             Network::random_geometric(800, 0.06, 3), Network::erdos_renyi(200, 0.0, 1)}) {
    std::vector<int> order = order_of(net);
    CHECK(order == order_of(net));
    const ConsensusPlan plan(net.offsets(), net.lists(), 1);
    std::vector<int> planned(plan.order().begin(), plan.order().end());
    REQUIRE(order.size() == static_cast<std::size_t>(net.agents()));
    REQUIRE(planned.size() == order.size());
    std::sort(order.begin(), order.end());
    std::sort(planned.begin(), planned.end());
    for (std::size_t k = 0; k < order.size(); ++k) CHECK(order[k] == static_cast<int>(k));
    CHECK(planned == order);
  }
}

TEST_CASE("neighbours come near each other") {
  CHECK(bandwidth(Network::path(200), order_of(Network::path(200))) == 1);
  CHECK(bandwidth(Network::ring(200), order_of(Network::ring(200))) == 2);
  CHECK(bandwidth(Network::grid(10, 300), order_of(Network::grid(10, 300))) <= 12);
}

TEST_CASE("rounds without a pool of threads, fused where rows do not fit the cache, keep the average") {
  test::Rng rng(6);
  for (const int N : {200, 30000}) {
    const Network net = Network::random_geometric(N, std::sqrt(12.0 / (3.14159 * N)), 2);
    const double alpha = 1.0 / (1.0 + net.max_degree());
    for (const int width : {1, 3, 8}) {
      const ConsensusPlan plan(net.offsets(), net.lists(), width);
      const auto w = static_cast<std::size_t>(width);
      std::vector<double> x(static_cast<std::size_t>(N) * w);
      for (double& v : x) v = test::uniform(rng, -1, 1);
      const auto mean = [&](const std::vector<double>& values, std::size_t k) {
        double sum = 0.0;
        for (std::size_t i = k; i < values.size(); i += w) sum += values[i];
        return sum / N;
      };
      std::vector<double> alone = x;
      std::vector<double> split = x;
      std::vector<double> scratch(x.size());
      Workers two(2);
      plan.run(alone.data(), scratch.data(), alpha, {}, 23, nullptr);
      plan.run(split.data(), scratch.data(), alpha, {}, 23, &two);
      CHECK(alone == split);
      for (std::size_t k = 0; k < w; ++k) CHECK(std::abs(mean(alone, k) - mean(x, k)) < 1e-14);
    }
  }
}
