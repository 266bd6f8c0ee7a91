// SPDX-License-Identifier: Apache-2.0
// Attack design: optima cannot be beaten, sweeps climb, predictions of damage are exact.
#include "garrison/filters/partial_sharing/attack.hpp"

#include <doctest/doctest.h>

#include "garrison/filters/partial_sharing/errors.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::partial_sharing;

namespace {

SelectionProblem random_problem(test::Rng& rng, int B, int m, int l) {
  const int size = B * m;
  const Matrix U = test::normal_matrix(rng, size, test::whole(rng, 1, size));
  const Matrix S = test::normal_matrix(rng, size, test::whole(rng, 1, size));
  return {(U * U.transpose()).cwiseProduct(S * S.transpose()), B, l};
}

Vector random_selection(test::Rng& rng, int B, int m, int l) {
  Vector s = Vector::Zero(B * m);
  for (int i = 0; i < B; ++i)
    for (int k = 0; k < l; ++k) s(i * m + test::whole(rng, 0, m - 1)) = 1.0;
  return s;
}

/// Every s, the plain way.
double brute_force(const SelectionProblem& p) {
  double best = 0.0;
  const int bits = p.blocks * p.size;
  for (int code = 0; code < (1 << bits); ++code) {
    Vector s(bits);
    bool allowed = true;
    for (int i = 0; i < p.blocks && allowed; ++i) {
      int ones = 0;
      for (int a = 0; a < p.size; ++a) {
        s(i * p.size + a) = (code >> (i * p.size + a)) & 1;
        ones += s(i * p.size + a) > 0 ? 1 : 0;
      }
      allowed = ones <= p.most;
    }
    if (allowed) best = std::max(best, p.objective(s));
  }
  return best;
}

}  // namespace

TEST_CASE("Gauss-Seidel sweeps with the true coupling never go down, 1500 random instances") {
  test::Rng rng(21);
  int printed_fell = 0;
  for (int k = 0; k < 1500; ++k) {
    const int B = test::whole(rng, 1, 5);
    const int m = test::whole(rng, 1, 6);
    const int l = test::whole(rng, 1, m);
    const SelectionProblem p = random_problem(rng, B, m, l);
    const Vector start = random_selection(rng, B, m, l);
    const Ascent a = ascent(p, start, 6, 2.0, true, false);
    for (std::size_t t = 1; t < a.objective.size(); ++t)
      CHECK(a.objective[t] >= a.objective[t - 1] * (1.0 - 1e-12));
    const Ascent printed = ascent(p, start, 6, 1.0, false);
    for (std::size_t t = 1; t < printed.objective.size(); ++t)
      if (printed.objective[t] < printed.objective[t - 1] * (1.0 - 1e-9)) {
        ++printed_fell;
        break;
      }
  }
  CHECK(printed_fell > 0);  // Algorithm 2 as printed is not monotone (docs/filters/partial_sharing.md#m11)
}

TEST_CASE("branch and bound finds the maximum of brute force, 80 instances") {
  test::Rng rng(22);
  for (int k = 0; k < 80; ++k) {
    const int B = test::whole(rng, 1, 3);
    const int m = test::whole(rng, 1, 4);
    const SelectionProblem p = random_problem(rng, B, m, test::whole(rng, 0, m));
    const ExactSelection e = exact_selection(p);
    CHECK(e.exact);
    CHECK(e.objective == doctest::Approx(brute_force(p)).epsilon(1e-10));
    CHECK(p.objective(e.s) == doctest::Approx(e.objective).epsilon(1e-12));
    CHECK(p.objective(best_of_starts(p, 4, 3)) <= e.objective * (1.0 + 1e-12));
  }
}

TEST_CASE("no covariance of the same energy does more than the optimal one, 40 networks x 30 covariances") {
  test::Rng rng(23);
  for (int k = 0; k < 40; ++k) {
    const int m = test::whole(rng, 1, 4);
    const int N = test::whole(rng, 2, 6);
    const Setting s = test::sharing_setting(rng, m, N, 0.1, {0.8, 1.0, k % 2 == 0});
    const auto gains = steady_gains(s);
    if (cycle_radius(s, gains) >= 0.999) continue;
    std::vector<int> liars;
    for (int i = 0; i < N; ++i)
      if (test::uniform(rng, 0, 1) < 0.5) liars.push_back(i);
    const double energy = test::uniform(rng, 0.5, 5);
    const WorstCovariance steady = worst_steady(s, gains, liars, energy);
    const WorstCovariance once = worst_one_step(s, gains, liars, energy, 2);
    const auto size = static_cast<int>(steady.form.rows());
    for (int trial = 0; trial < 30 && size > 0; ++trial) {
      const Matrix root = test::normal_matrix(rng, size, test::whole(rng, 1, size));
      Matrix Sigma = root * root.transpose();
      Sigma *= energy / Sigma.trace();
      CHECK((Sigma * steady.form).trace() <= steady.gain * (1.0 + 1e-12) + 1e-15);
      CHECK((Sigma * once.form).trace() <= once.gain * (1.0 + 1e-12) + 1e-15);
    }
    // The form predicts exactly what the periodic steady state pays.
    const Matrix Sigma = spread_covariance(s, liars, steady.covariance);
    double paid = 0.0;
    const auto with = periodic_covariance(s, gains, Sigma);
    const auto without = periodic_covariance(s, gains, Matrix());
    for (std::size_t f = 0; f < with.size(); ++f)
      paid += (with[f].trace() - without[f].trace()) / static_cast<double>(with.size());
    CHECK(std::abs(paid - steady.gain) <= 1e-9 * with[0].trace());
  }
}

TEST_CASE("nobody hears the liars: every covariance is optimal, and none is returned") {
  test::Rng rng(24);
  Setting s = test::sharing_setting(rng, 3, 3, 0.1);
  for (auto& list : s.hears) list.clear();
  const WorstCovariance w = worst_steady(s, steady_gains(s), {1}, 4.0);
  CHECK(w.gain == 0.0);
  CHECK(w.covariance.isZero(0.0));
}

TEST_CASE("bad energies, agents and covariances are refused") {
  test::Rng rng(25);
  const Setting s = test::sharing_setting(rng, 2, 4, 0.05, {0.7});
  const auto gains = steady_gains(s);
  CHECK_THROWS_WITH_AS(worst_steady(s, gains, {1}, -1.0), doctest::Contains("energy"), InvalidInput);
  CHECK_THROWS_WITH_AS(worst_steady(s, gains, {1, 1}, 1.0), doctest::Contains("twice"), InvalidInput);
  CHECK_THROWS_WITH_AS(worst_steady(s, gains, {4}, 1.0), doctest::Contains("agents in 0..3"), InvalidInput);
  Matrix Sigma = Matrix::Zero(8, 8);
  Sigma(0, 0) = 1.0;
  CHECK_THROWS_WITH_AS(check_attack(s, Sigma, {1}), doctest::Contains("regular agent 0"), InvalidInput);
  Sigma(0, 0) = -1.0;
  CHECK_THROWS_WITH_AS(check_attack(s, Sigma, {0}), doctest::Contains("semidefinite"), InvalidInput);
  Sigma(0, 0) = kNaN;
  CHECK_THROWS_WITH_AS(check_attack(s, Sigma, {0}), doctest::Contains("finite"), InvalidInput);
  CHECK_THROWS_WITH_AS(error_covariance(s, 3, Matrix(), -1), doctest::Contains("k0"), InvalidInput);
  CHECK_THROWS_AS(SelectionProblem(Matrix::Identity(4, 4), 2, 3), InvalidInput);
}
