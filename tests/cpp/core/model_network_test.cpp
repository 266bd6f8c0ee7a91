// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include <numbers>

#include "garrison/core/params.hpp"
#include "garrison/core/random.hpp"
#include "garrison/core/split_outputs.hpp"
#include "garrison/engine/any_filter.hpp"

using namespace garrison;

TEST_CASE("a model says what does not fit") {
  const Matrix A = Matrix::Identity(2, 2);
  CHECK_THROWS_WITH_AS(Model(Matrix::Zero(2, 3), {Matrix::Zero(1, 2)}), doctest::Contains("A: got 2 x 3"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(Model(A, {}), doctest::Contains("C: got no agent"), InvalidInput);
  CHECK_THROWS_WITH_AS(Model(A, {Matrix::Zero(1, 2), Matrix::Zero(1, 4)}),
                       doctest::Contains("C[1]: got 1 x 4"), InvalidInput);
  CHECK_THROWS_WITH_AS(Model(A * kNaN, {Matrix::Zero(1, 2)}), doctest::Contains("A[0, 0]: got nan"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(Model(A, {Matrix::Zero(1, 2)}, {-1.0, {}, {}, {}}),
                       doctest::Contains("process_bound: got -1"), InvalidInput);
  Matrix indefinite = A;
  indefinite(1, 1) = -1.0;
  CHECK_THROWS_WITH_AS(Model(A, {Matrix::Zero(1, 2)}, {kNaN, {}, indefinite, {}}),
                       doctest::Contains("least eigenvalue -1"), InvalidInput);
  const Model relay(A, {Matrix::Zero(0, 0), Matrix::Ones(3, 2)});
  CHECK(relay.outputs(0) == 0);
  CHECK(relay.total_outputs() == 3);
  CHECK(relay.offset(1) == 0);
}

TEST_CASE("a network says what does not fit, and counts double edges once") {
  const auto make = [](int agents, std::vector<Edge> edges) { return Network(agents, edges); };
  CHECK_THROWS_WITH_AS(make(3, {{0, 3}}), doctest::Contains("edges[0]: got (0, 3), expected indices in 0..2"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(make(3, {{0, 1}, {2, 2}}), doctest::Contains("edges[1]: got (2, 2), a self-loop"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(make(0, {}), doctest::Contains("agents: got 0"), InvalidInput);
  const Network twice = make(3, {{0, 1}, {1, 0}, {0, 1}, {1, 2}});
  CHECK(twice.edges().size() == 2);
  CHECK(twice.degree(0) == 1);
  CHECK_THROWS_WITH_AS(make(4, {{0, 1}, {2, 3}}).require_connected(), doctest::Contains("agent(s) 2, 3"),
                       InvalidInput);
  CHECK(Network(2, std::vector<Edge>{{0, 1}}, true).connected() == false);
}

TEST_CASE("generators") {
  CHECK(Network::ring(5).edges().size() == 5);
  CHECK(Network::ring(2).edges().size() == 1);
  CHECK(Network::path(5).edges().size() == 4);
  CHECK(Network::star(5).degree(0) == 4);
  CHECK(Network::complete(6).edges().size() == 15);
  CHECK(Network::grid(3, 4).edges().size() == 17);
  Matrix points;
  const Network rgg = Network::random_geometric(300, 0.1, 7, &points);
  CHECK(rgg.edges() == Network::random_geometric(300, 0.1, 7).edges());
  CHECK(rgg.edges() != Network::random_geometric(300, 0.1, 8).edges());
  std::size_t brute = 0;
  for (int i = 0; i < 300; ++i)
    for (int j = 0; j < i; ++j) brute += (points.row(i) - points.row(j)).norm() < 0.1 ? 1 : 0;
  CHECK(rgg.edges().size() == brute);
  CHECK(Network::erdos_renyi(40, 1.0, 1).edges().size() == 780);
  CHECK_THROWS_AS(Network::erdos_renyi(40, 1.5, 1), InvalidInput);
}

TEST_CASE("the spectrum agrees with closed forms, also where Lanczos finds it") {
  for (const int N : {3, 30, 401, 1000}) {
    const auto ring = Network::ring(N).laplacian_spectrum();
    CHECK(ring.lambda2 == doctest::Approx(2.0 - 2.0 * std::cos(2.0 * std::numbers::pi / N)).epsilon(1e-9));
    const auto path = Network::path(N).laplacian_spectrum();
    CHECK(path.lambda_max == doctest::Approx(2.0 + 2.0 * std::cos(std::numbers::pi / N)).epsilon(1e-9));
  }
  const auto star = Network::star(700).laplacian_spectrum();
  CHECK(star.lambda2 == doctest::Approx(1.0).epsilon(1e-9));
  CHECK(star.lambda_max == doctest::Approx(700.0).epsilon(1e-9));
  CHECK(Network::complete(1).laplacian_spectrum().lambda_max == 0.0);
}

TEST_CASE("weights") {
  const Network net = Network::random_geometric(40, 0.3, 3);
  const Matrix W = net.metropolis_weights();
  CHECK((W * Vector::Ones(40) - Vector::Ones(40)).norm() < 1e-12);
  CHECK(W.isApprox(W.transpose()));
  CHECK(W.minCoeff() >= 0.0);
  CHECK((net.max_degree_weights() * Vector::Ones(40) - Vector::Ones(40)).norm() < 1e-12);
}

TEST_CASE("philox gives the published numbers") {
  const auto block = philox({0, 0, 0, 0}, {0, 0});
  CHECK(block[0] == 0x6627e8d5U);
  CHECK(block[1] == 0xe169c58dU);
  CHECK(block[2] == 0xbc57ac4cU);
  CHECK(block[3] == 0x9b00dbd8U);
}

TEST_CASE("parameters are refused by name, with range and nearest name") {
  CHECK_THROWS_WITH_AS(make_filter("saturation", {{"treshold", 1.0}}),
                       doctest::Contains("did you mean \"threshold\"?"), InvalidInput);
  CHECK_THROWS_WITH_AS(make_filter("saturation", {{"threshold", -1.0}}),
                       doctest::Contains("saturation.threshold: got -1, expected a number > 0"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(make_filter("saturation", {{"threshold", 1.0}, {"rounds", std::int64_t{-1}}}),
                       doctest::Contains("saturation.rounds: got -1"), InvalidInput);
  CHECK_THROWS_WITH_AS(make_filter("saturation", {{"detector_index", std::string("t-1")}}),
                       doctest::Contains("one of: t, t+1"), InvalidInput);
  CHECK_THROWS_WITH_AS(make_filter("saturated", {}), doctest::Contains("did you mean \"saturation\"?"),
                       InvalidInput);
}

TEST_CASE("outputs are split into scalar sensors that hear each other") {
  const Model model(Matrix::Identity(2, 2), {Matrix::Identity(2, 2), Matrix(0, 2), Matrix::Ones(1, 2)},
                    {0.1, Vector::Constant(3, 0.2), {}, {}});
  const auto split = split_outputs(model, Network::path(3));
  CHECK(split.owner == std::vector<int>{0, 0, 1, 2});
  CHECK(split.model.total_outputs() == 3);
  CHECK(split.network.edges() == std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {2, 3}});
}
