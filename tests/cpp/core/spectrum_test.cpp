// SPDX-License-Identifier: Apache-2.0
// Spectra and weights, on both sides of the size where the dense solver gives way to Lanczos.
#include <doctest/doctest.h>

#include <numbers>

#include "core/solvers.hpp"
#include "garrison/core/network.hpp"

using namespace garrison;

namespace {

double path_eigenvalue(int k, int N) { return 2.0 - 2.0 * std::cos(std::numbers::pi * k / N); }

LaplacianSpectrum dense(const Network& net) {
  const Vector all =
      Eigen::SelfAdjointEigenSolver<Matrix>(net.laplacian(), Eigen::EigenvaluesOnly).eigenvalues();
  return {all(1), all(all.size() - 1)};
}

void check_equal(const LaplacianSpectrum& got, const LaplacianSpectrum& expected) {
  CHECK(got.lambda2 == doctest::Approx(expected.lambda2).epsilon(1e-9));
  CHECK(got.lambda_max == doctest::Approx(expected.lambda_max).epsilon(1e-9));
}

}  // namespace

TEST_CASE("grids have the sums of path eigenvalues") {
  for (const auto& [rows, columns] : {std::pair{4, 5}, {20, 20}, {20, 30}, {1, 600}, {2, 601}}) {
    CAPTURE(rows);
    CAPTURE(columns);
    const int most = std::max(rows, columns);
    check_equal(
        Network::grid(rows, columns).laplacian_spectrum(),
        {path_eigenvalue(1, most), path_eigenvalue(rows - 1, rows) + path_eigenvalue(columns - 1, columns)});
  }
  const auto ring = Network::ring(600).laplacian_spectrum();
  check_equal(ring, {path_eigenvalue(2, 600), 4.0});
}

TEST_CASE("multiple eigenvalues and irregular graphs, above the dense limit") {
  check_equal(Network::complete(450).laplacian_spectrum(), {450.0, 450.0});
  for (const std::uint64_t seed : {1U, 2U}) {
    const Network geometric = Network::random_geometric(450, 0.12, seed);
    const Network random = Network::erdos_renyi(450, 0.03, seed);
    if (geometric.connected()) check_equal(geometric.laplacian_spectrum(), dense(geometric));
    if (random.connected()) check_equal(random.laplacian_spectrum(), dense(random));
  }
}

TEST_CASE("well-connected networks, whose factors fill, take products alone") {
  for (const auto& [N, p] : {std::pair{900, 0.02}, {900, 0.2}, {1200, 0.01}}) {
    CAPTURE(N);
    CAPTURE(p);
    const Network net = Network::erdos_renyi(N, p, 3);
    REQUIRE(net.connected());
    check_equal(net.laplacian_spectrum(), dense(net));
  }
  // Two dense halves over one link: many products would be needed for lambda_2.
  std::vector<Edge> edges;
  for (int i = 0; i < 300; ++i)
    for (int j = i + 1; j < 300; ++j) edges.insert(edges.end(), {{i, j}, {300 + i, 300 + j}});
  edges.emplace_back(0, 300);
  const Network halves(600, edges);
  check_equal(halves.laplacian_spectrum(), dense(halves));
}

TEST_CASE("a large network of chords, whose factor no memory holds") {
  const int N = 1 << 15;
  const int most = 14;
  std::vector<Edge> edges;
  for (int k = 0; k < most; ++k)
    for (int i = 0; i < N; ++i) edges.emplace_back(i, (i + (1 << k)) % N);
  LaplacianSpectrum expected{kInfinity, 0.0};
  for (int j = 1; j < N; ++j) {
    double value = 0.0;
    for (int k = 0; k < most; ++k)
      value += 2.0 - 2.0 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(j) * (1 << k) / N));
    expected.lambda2 = std::min(expected.lambda2, value);
    expected.lambda_max = std::max(expected.lambda_max, value);
  }
  check_equal(Network(N, edges).laplacian_spectrum(), expected);
}

TEST_CASE("a graph in two parts has lambda_2 = 0, and says who is cut off") {
  for (const int N : {6, 500}) {
    std::vector<Edge> edges;
    for (int i = 0; i + 1 < N; ++i)
      if (i != N / 2 - 1) edges.emplace_back(i, i + 1);
    const Network net(N, edges);
    CHECK(!net.connected());
    CHECK(std::abs(net.laplacian_spectrum().lambda2) < 1e-12);
    CHECK_THROWS_WITH_AS(net.require_connected(), doctest::Contains("not connected (lambda_2 = 0)"),
                         InvalidInput);
  }
}

TEST_CASE("a directed network has in-neighbours, strong connection and no Laplacian spectrum") {
  const std::vector<Edge> circle{{0, 1}, {1, 2}, {2, 0}};
  const Network net(3, circle, true);
  CHECK(net.connected());
  CHECK(net.neighbours(1).size() == 1);
  CHECK(net.neighbours(1)[0] == 0);
  CHECK(net.edges() == circle);
  CHECK_THROWS_WITH_AS(net.laplacian_spectrum(), doctest::Contains("directed"), InvalidInput);
  CHECK_THROWS_WITH_AS(net.metropolis_weights(), doctest::Contains("max_degree_weights"), InvalidInput);
  CHECK((net.max_degree_weights() * Vector::Ones(3)).isApprox(Vector::Ones(3)));
  CHECK_THROWS_AS(net.laplacian_weights(0.0), InvalidInput);
  CHECK_THROWS_AS(net.laplacian_weights(kNaN), InvalidInput);
}

TEST_CASE("Metropolis weights are doubly stochastic and follow the graph") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Network net = Network::erdos_renyi(60, 0.1, seed);
    const Matrix W = net.metropolis_weights();
    CHECK((W.rowwise().sum().array() - 1.0).abs().maxCoeff() < 1e-14);
    CHECK((W.colwise().sum().array() - 1.0).abs().maxCoeff() < 1e-14);
    CHECK(W.minCoeff() >= 0.0);
    for (int i = 0; i < 60; ++i)
      for (const int j : net.neighbours(i))
        CHECK(W(i, j) == 1.0 / (1.0 + std::max(net.degree(i), net.degree(j))));
  }
}

TEST_CASE("generators give the degrees they promise, and the same network for the same seed") {
  for (int i = 0; i < 12; ++i) {
    CHECK(Network::ring(12).degree(i) == 2);
    CHECK(Network::complete(12).degree(i) == 11);
    CHECK(Network::star(12).degree(i) == (i == 0 ? 11 : 1));
    CHECK(Network::path(12).degree(i) == (i == 0 || i == 11 ? 1 : 2));
  }
  const Network grid = Network::grid(3, 4);
  CHECK(grid.degree(0) == 2);
  CHECK(grid.degree(5) == 4);
  CHECK(grid.max_degree() == 4);
  const Network a = Network::erdos_renyi(300, 0.1, 5);
  CHECK(a.edges() == Network::erdos_renyi(300, 0.1, 5).edges());
  CHECK(a.edges() != Network::erdos_renyi(300, 0.1, 6).edges());
  CHECK(std::abs(static_cast<double>(a.edges().size()) / (300.0 * 299.0 / 2.0) - 0.1) < 0.01);
  CHECK(Network::erdos_renyi(30, 0.0, 1).edges().empty());
  CHECK_THROWS_AS(Network::random_geometric(5, 0.0, 1), InvalidInput);
  CHECK_THROWS_AS(Network::random_geometric(0, 0.3, 1), InvalidInput);
  CHECK_THROWS_AS(Network::grid(0, 3), InvalidInput);
}
