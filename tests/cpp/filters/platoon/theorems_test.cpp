// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/platoon/theorems.hpp"

#include <doctest/doctest.h>

#include "core/solvers.hpp"
#include "garrison/filters/platoon/bounds.hpp"
#include "garrison/filters/platoon/loop.hpp"
#include "random_platoon.hpp"

using namespace garrison;
using namespace garrison::platoon;

TEST_CASE("the admissible intervals in closed form, against a scan over omega, in 300 random settings") {
  test::Rng rng(1);
  for (int run = 0; run < 300; ++run) {
    Setting s = test::random_platoon(rng).setting;
    const auto omega = omega_interval(s);
    const auto beta = beta_interval(s);
    double lo = kInfinity;
    double hi = 0.0;
    for (int k = 1; k < 1000; ++k) {
      const double w = k / 1000.0;
      const double b1 = beta1_bar(s, w);
      const double b2 = beta2_bar(s, w);
      const bool admits = b1 > 0.0 && b1 < b2;
      CHECK(admits == proposition2(s, w));
      if (std::abs(w - omega.lo) > 1e-9 && std::abs(w - omega.hi) > 1e-9)
        CHECK(admits == (w > omega.lo && w < omega.hi));
      if (admits) {
        lo = std::min(lo, b1);
        hi = std::max(hi, b2);
      }
    }
    if (hi == 0.0) continue;  // the scan is too coarse for it
    CHECK(lo >= beta.lo * (1.0 - 1e-12));
    CHECK(hi <= beta.hi * (1.0 + 1e-12));
  }
}

TEST_CASE("inside the safe interval the bound maps q below q, outside it does not") {
  test::Rng rng(2);
  for (int run = 0; run < 500; ++run) {
    Setting s = test::random_platoon(rng).setting;
    const auto all = beta_interval_safe(s);
    const Window nobody{0, 2 * s.range + 1, 0, 0};
    const auto next = [&](double beta) { return safe_bound(s, beta, predicted(s, s.q), nobody); };
    CHECK(next(all.lo * (1.0 + 1e-9)) < s.q);
    CHECK(next(all.lo * (1.0 - 1e-9)) > s.q);
    CHECK(next(all.hi * (1.0 - 1e-9)) < s.q);
    // The tight bound is never above the safe one, with the same counts.
    std::vector<double> noise;
    for (int d = s.range; d >= 0; --d)
      for (int k = 0; k < (d == 0 ? 1 : 2); ++k) noise.push_back((d + 1) * s.mu);
    CHECK(tight_bound(s, s.beta, predicted(s, s.q), nobody, 0.0, noise.data()) <=
          safe_bound(s, s.beta, predicted(s, s.q), nobody) * (1 + 1e-12));
    const double limit = safe_limit(s);
    if (s.adaptive) {
      REQUIRE_FALSE(std::isnan(limit));
      CHECK(safe_bound(s, threshold(s, predicted(s, limit)), predicted(s, limit), nobody) ==
            doctest::Approx(limit).epsilon(1e-9));
      Setting best = s;
      best.beta = best_threshold(s);
      CHECK(safe_limit(best) <= limit * (1.0 + 1e-6));
    }
  }
}

TEST_CASE("the blocks of P_0 give what the dense matrices give") {
  const double loops[][4] = {{3, 0.1, 2, 3}, {5, 0.01, 50, 50}, {8, 0.05, 5, 9}, {12, 0.02, 10, 20}};
  for (const auto& loop : loops) {
    const int N = static_cast<int>(loop[0]);
    const double T = loop[1], gs = loop[2], gv = loop[3];
    Matrix L = Matrix::Zero(N, N);
    for (int i = 0; i < N; ++i) {
      L(i, i) = i + 1 < N ? 2.0 : 1.0;
      if (i + 1 < N) L(i, i + 1) = L(i + 1, i) = -1.0;
    }
    Matrix P = Matrix::Zero(2 * N, 2 * N);
    Matrix A(2, 2);
    Matrix F(2, 2);
    A << 1, T, 0, 1;
    F << 0, 0, T * gs, T * gv;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        P.block(2 * i, 2 * j, 2, 2) = (i == j ? A : Matrix::Zero(2, 2)) - L(i, j) * F;
    const auto f = loop_factors(N, T, gs, gv);
    CHECK(f.rho == doctest::Approx(P.eigenvalues().cwiseAbs().maxCoeff()).epsilon(1e-9));
    CHECK(assumption4(N, T, gs, gv) == (f.rho < 1.0));
    Matrix M = Matrix::Identity(2 * N, 2 * N);  // by doubling: M = sum P'^k P^k
    Matrix power = P;
    for (int k = 0; k < 30; ++k) {
      M = (M + power.transpose() * M * power).eval();
      power = (power * power).eval();
    }
    const Vector eigen = Eigen::SelfAdjointEigenSolver<Matrix>(M).eigenvalues();
    CHECK(f.M_max == doctest::Approx(eigen(2 * N - 1)).epsilon(1e-8));
    CHECK(f.M_min == doctest::Approx(eigen(0)).epsilon(1e-8));
    const double MP = Eigen::JacobiSVD<Matrix>(M * P).singularValues()(0);
    CHECK(f.kappa == doctest::Approx(f.M_max + 2.0 * MP * MP).epsilon(1e-8));
    double sum = 0.0;
    for (Matrix Q = Matrix::Identity(2 * N, 2 * N);; Q = (Q * P).eval()) {
      const double term = Eigen::JacobiSVD<Matrix>(Q).singularValues()(0);
      sum += term;
      if (term < 1e-9) break;
    }
    CHECK(f.l1 == doctest::Approx(sum).epsilon(1e-8));
  }
  CHECK(std::isnan(loop_factors(5, 0.01, 50, 60).xi));
  CHECK_FALSE(assumption4(5, 0.01, 50, 60));
}

TEST_CASE("the advice of an infeasible threshold works") {
  Setting s;
  s.vehicles = 7;
  s.range = 3;
  s.attacked = 1;
  s.period = 0.1;
  s.eps = 0.01;
  s.mu = 1.0;
  s.q = 5.0;
  s.varpi = 1.5;
  s.beta = 1.0;
  test::Rng rng(9);
  int followed = 0;
  for (int k = 0; k < 300; ++k) {
    if (k > 0) {
      s.range = test::whole(rng, 1, 5);
      s.vehicles = 2 * s.range + 1 + test::whole(rng, 0, 4);
      s.attacked = test::whole(rng, 1, s.range);
      s.period = std::pow(10.0, test::uniform(rng, -2, 0));
      s.eps = std::pow(10.0, test::uniform(rng, -3, 1));
      s.mu = std::pow(10.0, test::uniform(rng, -3, 1));
      s.q = std::pow(10.0, test::uniform(rng, -2, 2));
      s.varpi = std::min(1.5, 0.5 * (1.0 + norm_A(s) / (norm_A(s) - 1.0)));
    }
    CAPTURE(k);
    std::string words;
    try {
      best_threshold(s);
      REQUIRE(k > 0);
      continue;
    } catch (const DesignInfeasible& e) {
      words = e.what();
    }
    const auto number = [&](const std::string& label) {
      const auto at = words.find(label);
      return at == std::string::npos ? kNaN : std::stod(words.substr(at + label.size()));
    };
    CAPTURE(words);
    Setting better = s;
    const double b = number("lower attacked (b) to ");
    const double q = number("raise initial_error (q) to ");
    if (std::isnan(b) && std::isnan(q)) {
      CHECK(words.find("no initial error helps") != std::string::npos);
      continue;
    }
    if (!std::isnan(b)) better.attacked = static_cast<int>(b);
    if (!std::isnan(q)) better.q = q;
    better.beta = best_threshold(better);
    CHECK(better.beta > 0.0);
    better.adaptive = true;
    CHECK(std::isfinite(safe_limit(better)));
    ++followed;
    if (k == 0) CHECK(q <= 20.0);  // about 10 mu
  }
  CHECK(followed > 20);
}
