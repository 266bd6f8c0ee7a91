// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/structural/gains.hpp"

#include <doctest/doctest.h>

#include "garrison/core/spectrum.hpp"
#include "garrison/filters/structural/errors.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::structural;

namespace {
double trace_of(const Setting& s, const GainMatrices& K) { return stationary(s, K).Q.trace(); }
}  // namespace

TEST_CASE("every gain returned is Schur, h2 is never worse, and no small change improves it") {
  test::Rng rng(41);
  int done = 0;
  for (int k = 0; k < 14; ++k) {
    const Setting s = test::random_setting(rng, test::whole(rng, 1, 4), test::whole(rng, 1, 4),
                                           test::uniform(rng, 0.8, 1.6));
    CAPTURE(k);
    for (const char* method : {"riccati", "kalman", "h2", "auto"}) {
      CAPTURE(method);
      try {
        const auto d = design_gains(s, method);
        CHECK(d.rho < 1.0);
        CHECK(spectral_radius(error_dynamics(s, d.K).Ahat) == doctest::Approx(d.rho).epsilon(1e-9));
        ++done;
      } catch (const DesignInfeasible& e) {
        CHECK(std::string(e.what()).find("spectral radius reached") != std::string::npos);
      }
    }
    const auto start = coupled_riccati(s, 3000).K;
    if (!start.front().allFinite() || !(error_radius(s, start) < 1.0)) continue;
    const auto best = h2_gains(s, start);
    const double trace = trace_of(s, best);
    CHECK(trace <= trace_of(s, start) * (1.0 + 1e-9));
    for (int trial = 0; trial < 10; ++trial) {
      GainMatrices other = best;
      for (auto& one : other) {
        const Matrix change = test::normal_matrix(rng, static_cast<int>(s.n()), static_cast<int>(s.n()));
        one += 1e-3 * one.norm() * change;
      }
      if (error_radius(s, other) < 1.0) CHECK(trace_of(s, other) >= trace * (1.0 - 1e-8));
    }
  }
  CHECK(done > 40);
}

TEST_CASE("discounting reaches a Schur gain from one that is not") {
  // Strongly unstable, sparsely shared: the greedy designs fail more often than h2 does.
  test::Rng rng(42);
  int reached = 0;
  for (int k = 0; k < 8; ++k) {
    Setting s = test::random_setting(rng, 3, 3, 1.0);
    s.A *= 1.3 / spectral_radius(s.A);
    s.U = Matrix::Identity(3, 3);
    const GainMatrices nothing(3, Matrix::Zero(3, 3));
    REQUIRE(error_radius(s, nothing) >= 1.0);
    try {
      reached += error_radius(s, h2_gains(s, nothing)) < 1.0 ? 1 : 0;
    } catch (const DesignInfeasible&) {
    }
  }
  CHECK(reached >= 4);
}

TEST_CASE(
    "Lemma 2 does not give a Schur gain: a = 3, one eye, self-weights 1/2 (docs/filters/structural.md#d20)") {
  Matrix C = Matrix::Zero(3, 1);
  C(0, 0) = 1.0;
  Matrix W(3, 3);
  W << 0.5, 0, 0.5, 0.5, 0.5, 0, 0, 0.5, 0.5;
  const Setting s{Matrix::Constant(1, 1, 3.0), C, W, Matrix::Identity(3, 3), Matrix::Constant(1, 1, 0.1),
                  Matrix::Identity(3, 3)};
  CHECK(best_scalar_gain(3.0, W).radius == doctest::Approx(1.5).epsilon(1e-9));
  CHECK_THROWS_WITH_AS(design_gains(s, "auto"), doctest::Contains("spectral radius reached: 1.5"),
                       DesignInfeasible);
  Matrix small(3, 3);
  small << 0.1, 0, 0.9, 0.9, 0.1, 0, 0, 0.9, 0.1;
  Setting cured = s;
  cured.W = small;
  CHECK(best_scalar_gain(3.0, small).radius == doctest::Approx(0.3).epsilon(1e-9));
  CHECK(design_gains(cured, "auto").rho < 1.0);
}

TEST_CASE("the isolation constraint holds for the hubs and costs little") {
  test::Rng rng(43);
  for (int k = 0; k < 3; ++k) {
    Setting s = test::random_setting(rng, 3, 3, 0.9);
    s.U.col(1).setOnes();
    const auto start = coupled_riccati(s);
    REQUIRE(start.converged);
    const std::vector<int> hubs{1};
    const auto K = h2_gains(s, start.K, hubs, 0.05);
    CHECK(error_radius(s, K) < 1.0);
    CHECK(isolation_ratios(s, K).col(1).maxCoeff() <= 0.05 * 1.01);
    CHECK(trace_of(s, K) >= trace_of(s, h2_gains(s, start.K)) * (1.0 - 1e-6));
  }
  const Setting s = test::random_setting(rng, 2, 2, 0.9);
  const GainMatrices K(2, Matrix::Zero(2, 2));
  CHECK_THROWS_AS(h2_gains(s, K, std::vector{2}), InvalidInput);
  CHECK_THROWS_AS(h2_gains(s, K, {}, 1.0), InvalidInput);
  CHECK_THROWS_WITH_AS(design_gains(s, "ricati"), doctest::Contains("riccati"), InvalidInput);
}
