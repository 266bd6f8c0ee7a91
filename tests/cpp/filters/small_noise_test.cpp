// SPDX-License-Identifier: Apache-2.0
// Steady-state designs at any ratio of process to measurement noise: they settle, or refuse, never stop
// early.
#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "garrison/filters/rdkf/steady_state.hpp"
#include "garrison/filters/structural/errors.hpp"
#include "garrison/filters/structural/gains.hpp"

using namespace garrison;
using Index = Eigen::Index;

namespace {

/// Pbar of x+ = x + w, y = x + v: q/2 + sqrt(q^2/4 + q r).
double scalar_prior(double q, double r) { return 0.5 * q + std::sqrt(0.25 * q * q + q * r); }

Model scalar(double a, double q, double r, int agents = 1) {
  Noise noise;
  noise.process_covariance = Matrix{{q}};
  noise.measurement_covariance.assign(static_cast<std::size_t>(agents), Matrix{{r}});
  return {Matrix{{a}}, std::vector<Matrix>(static_cast<std::size_t>(agents), Matrix{{1.0}}), noise};
}

structural::Setting alone(const Matrix& A, const Matrix& C, const Matrix& E, const Matrix& R) {
  const auto N = C.rows();
  return {A, C, Matrix::Constant(N, N, 1.0 / static_cast<double>(N)), Matrix::Ones(N, N), E, R};
}

}  // namespace

TEST_CASE("a random walk with q/r from 1e-16 to 1e16 has its closed form") {
  for (int power = -16; power <= 16; ++power)
    for (const double r : {1.0, 0.25, 1e8}) {
      const double q = r * std::pow(10.0, power);
      CAPTURE(power);
      CAPTURE(r);
      const double Pbar = scalar_prior(q, r);
      const auto s = rdkf::setting(scalar(1.0, q, r), Network(1, {}));
      const auto steady = rdkf::steady_state(s);
      CHECK(std::abs(steady.Pbar[0](0, 0) - Pbar) <= 1e-9 * Pbar);
      CHECK(steady.sweeps < 20000);
      const auto d =
          structural::design_gains(alone(Matrix{{1.0}}, Matrix{{1.0}}, Matrix{{q}}, Matrix{{r}}), "auto");
      CHECK(std::abs(d.K[0](0, 0) - Pbar / (Pbar + r)) <= 1e-9 * Pbar / (Pbar + r));
      CHECK(d.method == "riccati");
    }
}

TEST_CASE("process noise of nothing, or next to it: no unsettled gain is passed off as the best one") {
  const Matrix walk{{1.0}};
  const Matrix cruise{{1.0, 0.1}, {0.0, 1.0}};
  for (const double q : {0.0, 1e-300, 1e-200})
    for (const char* method : {"auto", "riccati", "h2"}) {
      CAPTURE(q);
      CAPTURE(method);
      for (const Index agents : {1, 3}) {
        const Matrix R = Matrix::Identity(agents, agents);
        const auto one = alone(walk, Matrix::Ones(agents, 1), Matrix{{q}}, R);
        CHECK_THROWS_AS(structural::design_gains(one, method), DesignInfeasible);
        Matrix C = Matrix::Zero(agents, 2);
        C.col(0).setOnes();
        const auto two = alone(cruise, C, q * Matrix::Identity(2, 2), R);
        CHECK_THROWS_AS(structural::design_gains(two, method), DesignInfeasible);
      }
    }
  // A mode that decays needs no noise: its best gain is q / (1 - a^2) / r to first order.
  for (const double q : {1e-300, 1e-30}) {
    const auto d = structural::design_gains(alone(Matrix{{0.9}}, walk, Matrix{{q}}, Matrix{{1.0}}), "auto");
    CHECK(std::abs(d.K[0](0, 0) - q / 0.19) <= 1e-6 * q / 0.19);
  }
}

TEST_CASE("measurement noise of nothing, or next to it") {
  const Matrix cruise{{1.0, 0.1}, {0.0, 1.0}};
  const Matrix I = Matrix::Identity(2, 2);
  const auto exact = structural::design_gains(alone(cruise, Matrix{{1.0, 0.0}}, I, Matrix{{1e-12}}), "auto");
  for (const double r : {0.0, 1e-300}) {
    const auto d = structural::design_gains(alone(cruise, Matrix{{1.0, 0.0}}, I, Matrix{{r}}), "auto");
    CHECK((d.K[0] - exact.K[0]).norm() <= 1e-6);
    // Both at once: only their ratio counts.
    const auto both = structural::design_gains(
        alone(Matrix{{1.0}}, Matrix{{1.0}}, Matrix{{1e-300}}, Matrix{{1e-300}}), "auto");
    CHECK(both.K[0](0, 0) == doctest::Approx(0.5 * (std::sqrt(5.0) - 1.0)).epsilon(1e-9));
  }
}

TEST_CASE("equal agents share the covariance of one: information averages") {
  // N equal agents with all in reach: every prior is the same, (5) is that of one agent.
  for (const double q : {1e-12, 1e-8, 1e-4}) {
    const auto s = rdkf::setting(scalar(1.0, q, 0.25, 4), Network::complete(4));
    const auto steady = rdkf::steady_state(s);
    for (const Matrix& Pbar : steady.Pbar)
      CHECK(std::abs(Pbar(0, 0) - scalar_prior(q, 0.25)) <= 1e-9 * scalar_prior(q, 0.25));
  }
}

TEST_CASE("random networks with little process noise: a fixed point of (5), from above and from below") {
  test::Rng rng(1);
  for (int k = 0; k < 20; ++k) {
    const int n = test::whole(rng, 1, 4);
    const int N = test::whole(rng, 1, 6);
    Matrix A = Matrix::Identity(n, n) + 0.01 * test::normal_matrix(rng, n, n);
    A /= std::max(1.0, Eigen::EigenSolver<Matrix>(A, false).eigenvalues().cwiseAbs().maxCoeff());
    Noise noise;
    noise.process_covariance = std::pow(10.0, test::whole(rng, -12, -5)) * Matrix::Identity(n, n);
    std::vector<Matrix> C;
    for (int i = 0; i < N; ++i) {
      C.push_back(test::normal_matrix(rng, n, n));
      noise.measurement_covariance.push_back(Matrix::Identity(n, n));
    }
    const auto s = rdkf::setting(Model(A, C, noise), test::connected_network(rng, N));
    const auto steady = rdkf::steady_state(s);
    auto below = steady.P;
    auto above = steady.P;
    for (Matrix& P : below) P *= 0.99;
    for (Matrix& P : above) P *= 1.01;
    const auto up = rdkf::riccati_sweep(s, below);
    const auto down = rdkf::riccati_sweep(s, above);
    CAPTURE(k);
    for (std::size_t i = 0; i < up.size();
         ++i) {  // the map is monotone and concave: it moves towards the fixed point
      CHECK(up[i].trace() > below[i].trace());
      CHECK(down[i].trace() < above[i].trace());
    }
    const auto again = rdkf::riccati_sweep(s, steady.P);
    for (std::size_t i = 0; i < again.size(); ++i)
      CHECK((again[i] - steady.P[i]).norm() <= 1e-11 * steady.P[i].norm());
  }
}

TEST_CASE(
    "the structural design with little process noise is not far from the best, or says that it does not "
    "settle") {
  test::Rng rng(2);
  for (int k = 0; k < 20; ++k) {
    const int N = test::whole(rng, 1, 5);
    const double q = std::pow(10.0, test::whole(rng, -14, -4));
    const auto s = alone(Matrix{{1.0}}, Matrix::Ones(N, 1), Matrix{{q}}, 0.25 * Matrix::Identity(N, N));
    const auto d = structural::design_gains(s, "auto");
    const double r = 0.25 / N;  // all measurements in every agent, all estimates equal: one Kalman filter
    const double best = scalar_prior(q, r) - q;
    const auto x = structural::stationary(s, d.K);
    CAPTURE(q);
    CAPTURE(N);
    CHECK(x.Q(0, 0) <= best * (1.0 + 1e-6));
    const auto joint = structural::joint_kalman(s);
    CHECK(joint.converged);
    CHECK(structural::stationary(s, joint.K).Q(0, 0) <= best * (1.0 + 1e-6));
  }
  const auto still = alone(Matrix{{1.0}}, Matrix{{1.0}}, Matrix{{0.0}}, Matrix{{1.0}});
  CHECK_THROWS_AS(structural::design_gains(still, "riccati"), DesignInfeasible);
}
