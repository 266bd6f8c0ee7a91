// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/quantiles.hpp"

#include <doctest/doctest.h>

#include <numbers>

#include "random_network.hpp"

using namespace garrison;
using namespace garrison::certificate;

TEST_CASE("levels agree with published tables and with the functions that they invert") {
  CHECK(two_sided(0.05) == doctest::Approx(1.959963984540054).epsilon(1e-15));
  CHECK(two_sided(1e-12) == doctest::Approx(7.130506848171324).epsilon(1e-15));
  CHECK(chi(0.05, 2) * chi(0.05, 2) == doctest::Approx(5.991464547107979).epsilon(1e-14));
  CHECK(chi(0.01, 7) * chi(0.01, 7) == doctest::Approx(18.475306906582357).epsilon(1e-13));
  CHECK(chi(0.001, 10) * chi(0.001, 10) == doctest::Approx(29.58829844507442).epsilon(1e-13));
  for (double delta = 1e-300; delta < 1.0; delta *= 7.3) {
    CAPTURE(delta);
    // Relative: far out, a change of the level by 1e-15 changes the tail by level^2 as much.
    const double z = two_sided(delta);
    CHECK(std::erfc(z / std::numbers::sqrt2) == doctest::Approx(delta).epsilon(1e-14 * (1.0 + z * z)));
    CHECK(chi(delta, 1) == z);
    // Two degrees: P = exp(-c^2/2). Four: exp(-u)(1 + u).
    CHECK(chi(delta, 2) == doctest::Approx(std::sqrt(-2.0 * std::log(delta))).epsilon(1e-13));
    const double u = 0.5 * chi(delta, 4) * chi(delta, 4);
    CHECK(std::log1p(u) - u == doctest::Approx(std::log(delta)).epsilon(1e-12));
    CHECK(sub_gaussian_two_sided(delta) >= z);
    for (const int n : {1, 2, 5, 30}) CHECK(sub_gaussian_chi(delta, n) >= chi(delta, n));
  }
}

TEST_CASE("levels near certainty and in many dimensions") {
  CHECK(two_sided(1.0 - 1e-10) == doctest::Approx(1e-10 * std::sqrt(std::numbers::pi / 2.0)).epsilon(1e-6));
  CHECK(chi(1.0 - std::ldexp(1.0, -40), 2) ==
        doctest::Approx(std::sqrt(std::ldexp(1.0, -39))).epsilon(1e-11));
  double before = 0.0;
  for (const int n : {1, 2, 3, 10, 100, 1000, 5000, 100000}) {
    const double c = chi(1e-6, n);
    CHECK(c > before);
    before = c;
    // Wilson and Hilferty's cube is within a tenth of a percent where it is good.
    const double wilson =
        std::sqrt(n * std::pow(1.0 - 2.0 / (9.0 * n) + 4.753424308822899 * std::sqrt(2.0 / (9.0 * n)), 3));
    if (n >= 100) CHECK(c == doctest::Approx(wilson).epsilon(1e-3));
  }
}

TEST_CASE("levels of both kinds fail as rarely as they say") {
  const Levels g = gaussian_levels(1e-3, 12, 3);
  CHECK(g.z1 == two_sided(0.5e-3 / 12));
  CHECK(g.z2 == chi(0.5e-3, 3));
  const Levels sg = sub_gaussian_levels(1e-3, 12, 3);
  CHECK(sg.z1 == doctest::Approx(std::sqrt(2.0 * std::log(2.0 * 12 / 0.5e-3))).epsilon(1e-14));
}

TEST_CASE("calibrated levels: order statistics of largest residuals and statistics") {
  // One sensor: both statistics are |v|/sigma, so both levels are the ceil((T+1)(1-delta/2))-th smallest.
  Matrix V(9, 1);
  V << 3, -1, 2, 9, -5, 4, 8, 6, -7;
  const Vector R = Vector::Constant(1, 4.0);
  const Levels l = calibrated_levels(V, R, 0, 0.5);  // the 8th of 9
  CHECK(l.z1 == 4.0);
  CHECK(l.z2 == doctest::Approx(4.0));
  // Against all sets, written out.
  test::Rng rng(5);
  const int T = 40;
  const int N = 6;
  const Matrix W = test::normal_matrix(rng, T, N);
  Vector S(N);
  for (double& r : S) r = test::uniform(rng, 0.1, 3.0);
  for (int s = 0; s <= 3; ++s) {
    std::vector<double> most(T, 0.0);
    for (int t = 0; t < T; ++t)
      for (int mask = 0; mask < 1 << N; ++mask) {
        if (__builtin_popcount(static_cast<unsigned>(mask)) < N - s) continue;
        double top = 0.0;
        double bottom = 0.0;
        for (int j = 0; j < N; ++j)
          if ((mask >> j & 1) != 0) {
            top += W(t, j) / S(j);
            bottom += 1.0 / S(j);
          }
        most[static_cast<std::size_t>(t)] =
            std::max(most[static_cast<std::size_t>(t)], std::abs(top) / std::sqrt(bottom));
      }
    std::sort(most.begin(), most.end());
    const auto rank = static_cast<std::size_t>(std::ceil((T + 1) * (1 - 0.05)));
    CHECK(calibrated_levels(W, S, s, 0.1).z2 == doctest::Approx(most[rank - 1]).epsilon(1e-12));
  }
}

TEST_CASE("levels refuse what is no probability, dimension or record") {
  for (const double delta : {0.0, 1.0, -0.1, kNaN, kInfinity}) {
    CHECK_THROWS_AS(two_sided(delta), InvalidInput);
    CHECK_THROWS_AS(chi(delta, 2), InvalidInput);
    CHECK_THROWS_AS(sub_gaussian_two_sided(delta), InvalidInput);
  }
  CHECK_THROWS_AS(chi(0.1, 0), InvalidInput);
  CHECK_THROWS_AS(gaussian_levels(0.1, 0, 1), InvalidInput);
  const Matrix V = Matrix::Ones(10, 3);
  const Vector R = Vector::Ones(3);
  CHECK_THROWS_AS(calibrated_levels(V, R, 3, 0.5), InvalidInput);
  CHECK_THROWS_AS(calibrated_levels(V, R, 0, 0.1), InvalidInput);  // 11 samples allow 2/11
  CHECK_THROWS_AS(calibrated_levels(V, Vector::Zero(3), 0, 0.5), InvalidInput);
}
