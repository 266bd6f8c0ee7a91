// SPDX-License-Identifier: Apache-2.0
// Certificates of nonlinear plants rest on the outputs that are linear, at the edge of their promise, and on
// nothing else: neither f, nor other outputs, nor earlier samples.
#include <doctest/doctest.h>

#include <iostream>

#include "../certificate/random_network.hpp"
#include "garrison/certificate/online/plan.hpp"
#include "garrison/garrison.hpp"

using namespace garrison;
using certificate::Spread;
using certificate::Wanted;

namespace {

constexpr int kSteps = 25;
constexpr int kAgents = 7;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One output each; the last one is not linear, and its row in the model says nothing of it.
struct Bent {
  Matrix A, C;
  Matrix operator()(const Matrix& X, const Vector&, int t) const {
    return (A * X).array() + (3.0 * X.array() + t).sin();
  }
  Vector seen(const Matrix& X) const {
    Vector y(kAgents);
    for (int i = 0; i + 1 < kAgents; ++i) y(i) = C.row(i).dot(X.col(i));
    y(kAgents - 1) = X.col(kAgents - 1).squaredNorm() / (1.0 + X.col(kAgents - 1).squaredNorm());
    return y;
  }
};

Bent draw(test::Rng& rng, int n) {
  return {0.3 * test::normal_matrix(rng, n, n), test::normal_matrix(rng, kAgents, n)};
}

Model model_of(const Bent& bent) {
  std::vector<Matrix> C;
  for (int i = 0; i < kAgents; ++i) C.emplace_back(bent.C.row(i));
  Noise noise;
  noise.measurement_covariance.assign(kAgents, Matrix::Constant(1, 1, 0.04));
  noise.process_covariance = 1e-6 * Matrix::Identity(bent.A.rows(), bent.A.rows());
  return {Matrix::Identity(bent.A.rows(), bent.A.rows()), C, noise};
}

std::shared_ptr<const Nonlinear> functions_of(const Bent& bent, std::vector<int> linear) {
  Nonlinear plant;
  plant.f = bent;
  plant.h = [bent](const Matrix& X, int) { return bent.seen(X); };
  plant.linear = std::move(linear);
  return std::make_shared<const Nonlinear>(std::move(plant));
}

std::shared_ptr<const Prepared> prepared(const Bent& bent, const Network& network, const Wanted& wanted) {
  const auto filter = make_filter("scalar_gain", {{"rounds", std::int64_t{3}}});
  return certified(*filter->prepare(model_of(bent), network), wanted);
}

}  // namespace

TEST_CASE("certificates hold at the edge of their promise on the linear outputs of a nonlinear plant") {
  test::Rng rng(20261130);
  int bounds = 0;
  double largest = 0.0;
  for (int k = 0; k < 60; ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 2);
    const Bent bent = draw(rng, n);
    const Network network = test::connected_network(rng, kAgents, 0.8);
    const Spread spread = k % 3 == 0 ? Spread::local : k % 3 == 1 ? Spread::direct : Spread::flooded;
    const auto design = prepared(bent, network, {spread, 1e-6, 1, 1000});
    const auto plan = design->certificate();
    const double edge = (1.0 - 1e-9) * std::min({plan->z1, plan->z2_full, plan->z2_partial});
    const int liar = test::whole(rng, 0, kAgents - 2);
    Rows y(kSteps, kAgents);
    Rows truth(kSteps + 1, n);
    Vector x = test::normal_matrix(rng, n, 1);
    truth.row(0) = x.transpose();
    for (int t = 0; t < kSteps; ++t) {
      x = bent(x, {}, t) +
          0.5 * test::normal_matrix(rng, n, 1);  // the process noise is not what the model says
      truth.row(t + 1) = x.transpose();
      y.row(t) =
          (bent.seen(x.replicate(1, kAgents)) + 0.2 * edge * test::unit_vector(rng, kAgents)).transpose();
      y(t, liar) += k % 2 == 0 ? 3.0 : 300.0;
      y(t, kAgents - 1) = 10.0 * test::normal_matrix(rng, 1, 1)(0);  // nor is this output what h says
    }
    RunOptions o;
    o.seed = static_cast<std::uint64_t>(k);
    o.nonlinear = functions_of(bent, {0, 1, 2, 3, 4, 5});
    if (k % 5 > 2) o.link.drop = 0.2;
    const Record record = replay(*design, Log{y.data(), truth.data(), 1, kSteps}, o);
    for (std::size_t row = kAgents; row < static_cast<std::size_t>((kSteps + 1) * kAgents); ++row) {
      CHECK_FALSE(record.error[row] > record.bound[row]);
      CHECK(std::isnan(record.published[row]));
      const auto kind = static_cast<CertificateKind>(record.bound_kind[row]);
      CHECK((spread != Spread::direct || kind != CertificateKind::relayed));
      if (!std::isfinite(record.bound[row])) continue;
      ++bounds;
      largest = std::max(largest, record.error[row] / record.bound[row]);
    }
  }
  std::cout << "linear outputs: " << bounds << " bounds, largest error/bound " << largest << "\n";
  CHECK(bounds > 60 * 60);
  CHECK(largest < 1.0);
}

TEST_CASE("outputs that are not linear, and certificates that need A, are refused") {
  test::Rng rng(3);
  const Bent bent = draw(rng, 2);
  const Network network = Network::complete(kAgents);
  const PlantOptions plant{5, Vector{{0.8, 0.0}}, 0.0, "none"};
  const auto refused = [&](std::vector<int> linear, const Wanted& wanted, const char* words) {
    RunOptions o;
    o.nonlinear = functions_of(bent, std::move(linear));
    CHECK_THROWS_WITH_AS(simulate(*prepared(bent, network, wanted), plant, o), doctest::Contains(words),
                         InvalidInput);
  };
  Wanted wanted{Spread::local, 1e-6, 1, 1000};
  refused({}, wanted, "certificate: got a plant by functions without linear outputs");
  refused({0, 6}, wanted, "linear: got output 6, of which h says");
  refused({0, 7}, wanted, "linear: got output 7, expected numbers of outputs, 0..6");
  wanted.memory = true;
  refused({0, 1}, wanted, "memory: got true with a plant by functions");
}
