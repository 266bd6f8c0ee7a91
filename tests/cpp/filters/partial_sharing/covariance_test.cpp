// SPDX-License-Identifier: Apache-2.0
// The local recursion (11) and the exact covariance (29).
#include <doctest/doctest.h>

#include <iostream>

#include "core/solvers.hpp"
#include "garrison/drivers/simulate.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::partial_sharing;

namespace {

double least(const Matrix& M) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(M, Eigen::EigenvaluesOnly).eigenvalues()(0);
}

}  // namespace

TEST_CASE("the square-root step is (9) and (11) in Joseph form, for 60 random agents") {
  test::Rng rng(1);
  for (int k = 0; k < 60; ++k) {
    const int m = test::whole(rng, 1, 9);
    const Setting s = test::sharing_setting(rng, m, 4, 0.2, {1.1, 1.0, false, false});
    for (int i = 0; i < 4; ++i) {
      LocalRecursion recursion(s, i);
      const auto at = static_cast<std::size_t>(i);
      const Matrix& H = s.H[at];
      for (int t = 0; t < 5; ++t) {
        const LocalGains g = recursion.step();
        const Matrix M = s.R[at] + H * g.P * H.transpose();
        const Matrix K = H.rows() == 0 ? Matrix(m, 0) : Matrix(s.A * g.P * H.transpose() * M.inverse());
        const Matrix F = s.A - K * H;
        const Matrix next = F * g.P * F.transpose() + K * s.R[at] * K.transpose() + s.Q;
        const double scale = 1.0 + next.norm();
        CHECK((g.K - K).norm() <= 1e-9 * (1.0 + K.norm()));
        CHECK((g.C - s.gamma * F * g.P).norm() <= 1e-9 * scale);
        CHECK((recursion.P() - next).norm() <= 1e-9 * scale);
      }
    }
  }
}

TEST_CASE("covariances stay symmetric positive semidefinite over 1e5 steps") {
  // Tiny R, unstable but detectable plants, singular Q, huge or singular P0.
  struct Hard {
    double r, radius, q, p0;
  };
  for (const Hard& hard :
       {Hard{1e-20, 1.4, 1.0, 1.0}, Hard{1e-12, 1.05, 0.0, 1e8}, Hard{1.0, 2.0, 1e-16, 0.0},
        Hard{1e-30, 1.2, 0.0, 1e12}, Hard{1e6, 1.1, 1e-8, 1e-8}}) {
    test::Rng rng(7);
    Setting s = test::sharing_setting(rng, 4, 2, 0.1, {hard.radius, 1.0, false, true});
    for (Matrix& R : s.R) R = hard.r * Matrix::Identity(4, 4);
    s.H[0] = s.H[0].topRows(1).replicate(4, 1);  // rank one: four equal sensors
    s.Q = hard.q * Matrix::Identity(4, 4);
    s.Q(0, 0) = 0.0;
    s.P0 = hard.p0 * Matrix::Identity(4, 4);
    CAPTURE(hard.r);
    CAPTURE(hard.radius);
    for (int i = 0; i < 2; ++i) {
      LocalRecursion recursion(s, i);
      bool good = true;
      for (int t = 0; t < test::tried(100000); ++t) {
        recursion.step();
        const Matrix& P = recursion.P();
        good = good && P.allFinite() && P == P.transpose();
        if (t < 200 || t % 997 == 0) good = good && least(P) >= -1e-14 * P.cwiseAbs().maxCoeff();
      }
      CHECK(good);
    }
  }
}

TEST_CASE("the steady covariance solves the Riccati equation, for 100 random agents") {
  test::Rng rng(3);
  for (int k = 0; k < 100; ++k) {
    const int m = test::whole(rng, 1, 8);
    const Setting s = test::sharing_setting(rng, m, 1, 0.2, {test::uniform(rng, 0.1, 1.5), 1.0});
    const LocalGains g = steady_gains(s, 0);
    const Matrix next = g.F * g.P * g.F.transpose() + g.K * s.R[0] * g.K.transpose() + s.Q;
    CHECK((next - g.P).norm() <= 1e-12 * g.P.norm());
  }
}

TEST_CASE("cycle radius below 1 exactly when covariances stay bounded, 120 random networks") {
  test::Rng rng(11);
  int stable = 0;
  int unstable = 0;
  for (int k = 0; k < 120; ++k) {
    const int m = test::whole(rng, 1, 4);
    const int N = test::whole(rng, 1, 5);
    const double gain = std::pow(10.0, test::uniform(rng, -2, 2));
    const Setting s = test::sharing_setting(rng, m, N, gain, {test::uniform(rng, 0.3, 1.3), 1.0, k % 2 == 0});
    const auto gains = steady_gains(s);
    const double radius = cycle_radius(s, gains);
    if (std::abs(radius - 1.0) < 0.02) continue;
    Matrix P = Matrix::Identity(s.size(), s.size());
    const Matrix Qt = noise_covariance(s, gains);
    double before = 0.0;
    for (int t = 0; t < 1200 && P.trace() < 1e100; ++t) {
      if (t == 600) before = P.trace();
      P = covariance_step(s, gains, t, P, Matrix());
    }
    const bool bounded = P.trace() < 2.0 * before;
    CHECK(bounded == (radius < 1.0));
    ++(radius < 1.0 ? stable : unstable);
    if (radius < 1.0) {
      const auto phases = periodic_covariance(s, gains, Matrix());
      const auto at = static_cast<std::size_t>(1200 % s.selection.period());
      CHECK((P - phases[at]).norm() <= 1e-6 * P.norm());
      CHECK(least(phases[at]) >= -1e-12 * phases[at].norm());
    } else {
      CHECK_THROWS_WITH_AS(periodic_covariance(s, gains, Matrix()), doctest::Contains("no steady state"),
                           InvalidInput);
    }
  }
  CHECK(stable > 30);
  CHECK(unstable > 20);
}

TEST_CASE("simulated errors have the exact covariance (29), attacked and not") {
  test::Rng rng(5);
  const auto [model, net] = test::sharing_problem(rng, 3, 5, {1.02, 1.0, false, true});
  PartialSharing::Params p;
  p.gain = 0.15;
  p.shared = 2;
  p.shift = 2;
  p.start_is_prediction = true;
  // Truth and estimates begin at 0: the first predictions are wrong by w(0), all alike.
  const Matrix& Q = model.noise().process_covariance;
  p.start_covariance.assign(Q.data(), Q.data() + 9);
  const Setting s = make_setting(p, model, net);
  const int trials = 4000;
  const int steps = 25;
  const std::vector<int> liars{1, 4};
  const Matrix block = test::covariance(rng, 6, 3.0);
  for (const bool attacked : {false, true}) {
    Matrix Sigma = Matrix::Zero(15, 15);
    if (attacked)
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          Sigma.block(3 * liars[static_cast<std::size_t>(i)], 3 * liars[static_cast<std::size_t>(j)], 3, 3) =
              block.block(3 * i, 3 * j, 3, 3);
    // The run's estimates are updated ones; its last prediction is A z(steps), of x(steps + 1).
    const Trajectory exact = error_covariance(s, steps, Sigma, 10);
    const PlantOptions plant{steps + 1, Vector::Zero(3), 0.0, "normal"};
    RunOptions o;
    o.trials = trials;
    o.seed = 12;
    o.start = Matrix::Zero(3, 5);
    o.keep = {true, false, false, false};
    if (attacked) o.message_attacks = {coordinated(Schedule(11, liars), block)};
    const Record r = simulate(model, net, *make_filter("partial_sharing", values(p)), plant, o);
    double sum = 0.0;
    for (std::size_t k = 0; k < trials; ++k) {
      const double* truth = r.truth.data() + (k * (steps + 2) + steps + 1) * 3;
      for (std::size_t i = 0; i < 5; ++i) {
        const Eigen::Map<const Vector> z(r.estimate.data() + ((k * (steps + 2) + steps) * 5 + i) * 3, 3);
        sum += (model.A() * z - Eigen::Map<const Vector>(truth, 3)).squaredNorm();
      }
    }
    const double sampled = sum / trials;
    std::cout << (attacked ? "attacked" : "no attack") << ": NMSE of " << trials << " trials " << sampled
              << ", exact " << exact.nmse.back() << "\n";
    // Standard deviation of a sampled variance: below 2 / sqrt(trials) of it for so few degrees of freedom.
    CHECK(std::abs(sampled - exact.nmse.back()) < 4.0 * 2.0 / std::sqrt(trials) * exact.nmse.back());
  }
}
