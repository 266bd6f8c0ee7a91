// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/plan/consensus.hpp"

#include <doctest/doctest.h>

#include <cstring>

#include "../random_system.hpp"
#include "core/solvers.hpp"
#include "garrison/kernel/average.hpp"
#include "garrison/kernel/chebyshev.hpp"

using namespace garrison;

namespace {

/// Agent by agent, in public order, with the function that filters use.
std::vector<double> one_by_one(const Network& net, std::vector<double> x, int width, double alpha,
                               const std::vector<double>& omega, int rounds) {
  const auto w = static_cast<std::size_t>(width);
  std::vector<double> previous = x;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<double> now = x;
    for (int i = 0; i < net.agents(); ++i) {
      const auto neighbours = net.neighbours(i);
      average_round<Dynamic>(
          width, alpha, omega.empty() ? 1.0 : omega[static_cast<std::size_t>(round)],
          x.data() + static_cast<std::size_t>(i) * w, previous.data() + static_cast<std::size_t>(i) * w,
          neighbours.size(),
          [&](std::size_t k) { return now.data() + static_cast<std::size_t>(neighbours[k]) * w; });
    }
  }
  return x;
}

std::vector<double> at_once(const Network& net, const std::vector<double>& x, int width, double alpha,
                            const std::vector<double>& omega, int rounds, int threads) {
  const ConsensusPlan plan(net.offsets(), net.lists(), width);
  const auto w = static_cast<std::ptrdiff_t>(width);
  std::vector<double> memory(1 + x.size());
  std::vector<double> scratch(1 + x.size());
  std::vector<double> out(x.size());
  double* const inner = memory.data() + 1;  // on no boundary that a vector register would like
  for (std::size_t k = 0; k < plan.order().size(); ++k)
    std::copy_n(x.begin() + plan.order()[k] * w, w, inner + static_cast<std::ptrdiff_t>(k) * w);
  Workers workers(threads);
  plan.run(inner, scratch.data() + 1, alpha, omega, rounds, &workers);
  for (std::size_t k = 0; k < plan.order().size(); ++k)
    std::copy_n(inner + static_cast<std::ptrdiff_t>(k) * w, w, out.begin() + plan.order()[k] * w);
  return out;
}

std::vector<double> random_values(std::size_t size, test::Rng& rng) {
  std::vector<double> x(size);
  for (double& v : x) v = test::uniform(rng, -3, 3);
  return x;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("all at once gives the bits of agent by agent") {
  test::Rng rng(11);
  const std::vector<Edge> one_edge{{0, 3}};
  const std::vector<Network> nets{Network::complete(1),
                                  Network::star(9),
                                  Network::path(12),
                                  Network(5, one_edge),
                                  Network::random_geometric(300, 0.12, 4),
                                  Network::ring(2)};
  for (const auto& net : nets)
    for (const int width : {1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 24, 32, 40, 48, 56, 64})
      for (const int rounds : {0, 1, 2, 7, 20}) {
        const double alpha = 1.0 / (1.0 + net.max_degree());
        const auto x = random_values(static_cast<std::size_t>(net.agents() * width), rng);
        for (const auto& omega : {std::vector<double>{}, chebyshev_weights(0.9, rounds)}) {
          CAPTURE(net.agents());
          CAPTURE(width);
          CAPTURE(rounds);
          const auto expected = one_by_one(net, x, width, alpha, omega, rounds);
          CHECK(same_bits(at_once(net, x, width, alpha, omega, rounds, 1), expected));
          CHECK(same_bits(at_once(net, x, width, alpha, omega, rounds, 3), expected));
        }
      }
}

TEST_CASE("fused rounds on a network that does not fit into the cache") {
  test::Rng rng(12);
  const Network net = Network::random_geometric(30000, std::sqrt(8.0 / (3.14159 * 30000)), 5);
  const double alpha = 1.0 / (1.0 + net.max_degree());
  const auto x = random_values(30000UL * 8UL, rng);
  for (const auto& omega : {std::vector<double>{}, chebyshev_weights(0.97, 20)}) {
    const auto expected = one_by_one(net, x, 8, alpha, omega, 20);
    CHECK(same_bits(at_once(net, x, 8, alpha, omega, 20, 1), expected));
    CHECK(same_bits(at_once(net, x, 8, alpha, omega, 20, 2), expected));
  }
}

TEST_CASE("chebyshev weights contract as they say and keep the mean") {
  const Network net = Network::random_geometric(30, 0.3, 9);
  const auto [lambda2, lambda_max] = net.laplacian_spectrum();
  REQUIRE(lambda2 > 0.0);
  const double alpha = 2.0 / (lambda2 + lambda_max);
  const double gamma = (lambda_max - lambda2) / (lambda_max + lambda2);
  const Matrix W = net.laplacian_weights(alpha);
  for (const int rounds : {1, 2, 5, 12}) {
    const auto omega = chebyshev_weights(gamma, rounds);
    Matrix before = Matrix::Identity(30, 30);
    Matrix now = W;
    for (int l = 1; l < rounds; ++l) {
      const double o = omega[static_cast<std::size_t>(l)];
      const Matrix next = o * W * now - (o - 1.0) * before;
      before = now;
      now = next;
    }
    const Matrix rest = now - Matrix::Constant(30, 30, 1.0 / 30);
    const double norm = Eigen::SelfAdjointEigenSolver<Matrix>(rest).eigenvalues().cwiseAbs().maxCoeff();
    CHECK(norm == doctest::Approx(chebyshev_contraction(gamma, rounds)).epsilon(1e-9));
    CHECK(chebyshev_contraction(gamma, rounds) <= std::pow(gamma, rounds) * (1 + 1e-12));
    CHECK((now * Vector::Ones(30) - Vector::Ones(30)).norm() < 1e-10);
  }
  CHECK(chebyshev_contraction(0.0, 3) == 0.0);
  CHECK(chebyshev_contraction(0.5, 0) == 1.0);
}
