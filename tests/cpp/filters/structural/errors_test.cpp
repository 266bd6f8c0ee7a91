// SPDX-License-Identifier: Apache-2.0
// Exact moments against their defining recursions and against simulation.
#include <doctest/doctest.h>

#include "core/solvers.hpp"
#include "garrison/core/spectrum.hpp"
#include "garrison/filters/structural/detection.hpp"
#include "garrison/filters/structural/gains.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::structural;

namespace {

/// Errors and residuals agent by agent, straight from (3), (4), (14) for the error x - xhat.
struct Simulation {
  explicit Simulation(const Setting& setting, const GainMatrices& gains, std::uint64_t seed)
      : s(setting), K(gains), rng(seed), e(Matrix::Zero(s.n(), s.N())) {
    E = s.E.llt().matrixL();
    R = s.R.llt().matrixL();
  }
  Vector step(const Vector& attack) {
    const Vector nu = E * test::normal_matrix(rng, static_cast<int>(s.n()), 1);
    const Vector zeta = R * test::normal_matrix(rng, static_cast<int>(s.N()), 1) + attack;
    const Matrix prior = s.A * e * s.W.transpose() + nu * Matrix::Ones(1, s.N());
    Vector r(s.N());
    for (Eigen::Index i = 0; i < s.N(); ++i) {
      Vector sum = Vector::Zero(s.n());
      for (Eigen::Index j = 0; j < s.N(); ++j)
        if (s.U(i, j) != 0.0) sum += s.C.row(j).transpose() * (s.C.row(j).dot(prior.col(i)) + zeta(j));
      e.col(i) = prior.col(i) - K[static_cast<std::size_t>(i)] * sum;
      r(i) = s.C.row(i).dot(e.col(i)) + zeta(i);
    }
    return r;
  }
  const Setting& s;
  const GainMatrices& K;
  test::Rng rng;
  Matrix e, E, R;
};

}  // namespace

TEST_CASE("the false-alarm rate is the one asked for, on random systems with correlated noise") {
  test::Rng rng(31);
  for (int k = 0; k < 5; ++k) {
    const Setting s = test::random_setting(rng, test::whole(rng, 1, 4), test::whole(rng, 1, 4), 1.05);
    const auto design = design_gains(s, "auto");
    REQUIRE(design.rho < 1.0);
    const Stationary x = stationary(s, design.K, 2);
    Simulation sim(s, design.K, static_cast<std::uint64_t>(k));
    constexpr int kSteps = 40000;
    const double rate = 0.05;
    const Vector threshold = thresholds(x.residual_std, level_of_false_alarm(rate));
    Vector count = Vector::Zero(s.N());
    Matrix moment = Matrix::Zero(s.N(), s.N());
    Matrix lagged = Matrix::Zero(s.N(), s.N());
    Vector before = Vector::Zero(s.N());
    for (int t = 0; t < kSteps + 300; ++t) {
      const Vector r = sim.step(Vector::Zero(s.N()));
      if (t >= 300) {
        count += (r.cwiseAbs().array() >= threshold.array()).cast<double>().matrix();
        moment += r * r.transpose();
        lagged += r * before.transpose();
      }
      before = r;
    }
    // Residuals are correlated in time, so the deviation allowed is that of a tenth as many samples.
    const double allowed = 4.5 * std::sqrt(rate * (1 - rate) / (0.1 * kSteps));
    CAPTURE(k);
    CHECK((count / kSteps - Vector::Constant(s.N(), rate)).cwiseAbs().maxCoeff() < allowed);
    const double scale = x.covariances[0].cwiseAbs().maxCoeff();
    CHECK((moment / kSteps - x.covariances[0]).cwiseAbs().maxCoeff() < 0.08 * scale);
    CHECK((lagged / kSteps - x.covariances[1]).cwiseAbs().maxCoeff() < 0.08 * scale);
  }
}

TEST_CASE("the corrected bound (10) holds whenever it exists; Riccati bounds hold and certify stability") {
  test::Rng rng(32);
  int bounded = 0;
  int settled = 0;
  for (int k = 0; k < 60; ++k) {
    const Setting s = test::random_setting(rng, test::whole(rng, 1, 5), test::whole(rng, 1, 5),
                                           test::uniform(rng, 0.3, 1.3));
    const auto g = coupled_riccati(s, 5000);
    if (!g.converged) continue;
    ++settled;
    CAPTURE(k);
    CHECK(error_radius(s, g.K) < 1.0);
    const Stationary x = stationary(s, g.K);
    for (Eigen::Index i = 0; i < s.N(); ++i) {
      const Matrix gap = g.P[static_cast<std::size_t>(i)] - x.Q.block(i * s.n(), i * s.n(), s.n(), s.n());
      const double least = Eigen::SelfAdjointEigenSolver<Matrix>(gap).eigenvalues()(0);
      CHECK(least >= -1e-10 * x.Q.cwiseAbs().maxCoeff());
    }
    const auto bound = covariance_bound(s, g.K, false);
    if (!std::isfinite(bound.bound)) {
      CHECK(bound.b >= 1.0);
      continue;
    }
    ++bounded;
    CHECK(spectral_radius(x.Q) <= bound.bound * (1.0 + 1e-12));
  }
  CHECK(settled > 30);
  CHECK(bounded > 5);
}

TEST_CASE("the printed noise term gives a false bound (docs/filters/structural.md#d12)") {
  constexpr int N = 5;
  Setting s{Matrix::Constant(1, 1, 0.5), Matrix::Ones(N, 1),          Matrix::Constant(N, N, 0.2),
            Matrix::Ones(N, N),          Matrix::Constant(1, 1, 0.0), Matrix::Identity(N, N)};
  const GainMatrices K(N, Matrix::Constant(1, 1, 0.2));
  const double norm = spectral_radius(stationary(s, K).Q);
  CHECK(norm == doctest::Approx(1.0));
  CHECK(covariance_bound(s, K, true).bound < norm);
  CHECK(covariance_bound(s, K, false).bound >= norm * (1.0 - 1e-12));
}

TEST_CASE("steady responses and exposure: an attack of the smallest seen size is seen as often as said") {
  test::Rng rng(33);
  const Setting s = test::random_setting(rng, 3, 3, 0.95);
  const auto design = design_gains(s, "riccati");
  const Stationary x = stationary(s, design.K);
  const Matrix response = step_response(s, design.K, 1, 2000);
  CHECK((response.bottomRows(1).transpose() - x.dc_gain.col(1)).cwiseAbs().maxCoeff() < 1e-9);
  const auto all = exposure(s, x, 0.01, 0.9);
  const auto& e = all[1];
  REQUIRE(e.seen_by >= 0);
  Simulation sim(s, design.K, 5);
  const Vector threshold = thresholds(x.residual_std, level_of_false_alarm(0.01));
  Vector attack = Vector::Zero(3);
  attack(1) = e.smallest_seen;
  int seen = 0;
  Matrix mean = Matrix::Zero(3, 3);
  constexpr int kSteps = 20000;
  for (int t = 0; t < kSteps + 300; ++t) {
    const Vector r = sim.step(attack);
    if (t < 300) continue;
    seen += std::abs(r(e.seen_by)) >= threshold(e.seen_by) ? 1 : 0;
    mean += sim.e / kSteps;
  }
  CHECK(static_cast<double>(seen) / kSteps == doctest::Approx(0.9).epsilon(0.03));
  CHECK(mean.colwise().norm().maxCoeff() == doctest::Approx(e.largest_harm).epsilon(0.05));
}

TEST_CASE("the spectral radius of a large network is found without its matrix") {
  test::Rng rng(34);
  const Setting s = test::random_setting(rng, 10, 45, 1.0);
  const auto g = coupled_riccati(s, 400, 1e-8);
  const double sparse = error_radius(s, g.K);
  CHECK(sparse == doctest::Approx(spectral_radius(error_dynamics(s, g.K).Ahat)).epsilon(1e-6));
}

TEST_CASE("levels: Gaussian and chi-square") {
  CHECK(kappa(2.0) == doctest::Approx(0.9544997361036416).epsilon(1e-14));
  CHECK(level_of_false_alarm(1.0 - 0.9544997361036416) == doctest::Approx(2.0).epsilon(1e-13));
  CHECK(level_of_false_alarm(1e-12) == doctest::Approx(7.130506848171324).epsilon(1e-12));
  CHECK(chi_square_level(1, 0.05) == doctest::Approx(3.841458820694124).epsilon(1e-12));
  CHECK(chi_square_level(2, 0.05) == doctest::Approx(5.991464547107979).epsilon(1e-12));
  CHECK(chi_square_level(7, 0.01) == doctest::Approx(18.475306906582357).epsilon(1e-12));
  CHECK(chi_square_level(10, 0.001) == doctest::Approx(29.58829844507442).epsilon(1e-12));
  CHECK(power(0.0, 1.0, 2.0) == doctest::Approx(1.0 - kappa(2.0)));
  CHECK_THROWS_AS(kappa(0.0), InvalidInput);
  CHECK_THROWS_AS(level_of_false_alarm(1.0), InvalidInput);
  CHECK_THROWS_AS(chi_square_level(0, 0.1), InvalidInput);
  CHECK(alarms(Matrix::Constant(1, 1, kNaN), Vector::Ones(1)).front() == std::vector{0});
}

TEST_CASE("settings and gains are refused with which, got, expected") {
  test::Rng rng(35);
  const Setting good = test::random_setting(rng, 2, 3, 0.9);
  const auto refused = [&](auto&& change, const char* words) {
    Setting s = good;
    change(s);
    CHECK_THROWS_WITH_AS(coupled_riccati(s), doctest::Contains(words), InvalidInput);
  };
  refused([](Setting& s) { s.W.row(1) *= 0.5; }, "row 1 of W: got a sum of 0.5");
  refused([](Setting& s) { s.W(0, 0) = -0.1; }, "W[0, 0]: got -0.1");
  refused([](Setting& s) { s.U(2, 2) = 0.0; }, "U[2, 2]: got 0");
  refused([](Setting& s) { s.U(1, 2) = 0.5; }, "U[1, 2]: got 0.5");
  refused([](Setting& s) { s.R(0, 1) += 0.1; }, "R: got a matrix that is not symmetric");
  refused([](Setting& s) { s.E *= -1.0; }, "E: got least eigenvalue");
  refused([](Setting& s) { s.C(1, 0) = kNaN; }, "C[1, 0]: got nan");
  refused([](Setting& s) { s.U.conservativeResize(2, 3); }, "U: got 2 x 3");
  const GainMatrices none(3, Matrix::Zero(2, 2));
  Setting unstable = good;
  unstable.A *= 60.0;
  CHECK_THROWS_WITH_AS(stationary(unstable, none), doctest::Contains("spectral radius"), InvalidInput);
  CHECK_THROWS_AS(stationary(good, GainMatrices(2, Matrix::Zero(2, 2))), InvalidInput);
  CHECK_THROWS_AS(step_response(good, none, 3, 5), InvalidInput);
  CHECK_THROWS_WITH_AS(thresholds_printed(good, kInfinity, 2.0), doctest::Contains("|Ahat|_2 < 1"),
                       InvalidInput);
}
