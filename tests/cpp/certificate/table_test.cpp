// SPDX-License-Identifier: Apache-2.0
// A search for an error beyond T, TG or I: the filter's own recursion, noise at its bounds, attackers at the
// level.
#include <doctest/doctest.h>

#include <iostream>

#include "garrison/certificate/gaussian_table.hpp"
#include "garrison/certificate/informed.hpp"
#include "garrison/certificate/quantiles.hpp"
#include "random_network.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

constexpr std::uint64_t kSeed = 20261128;

/// The saturated filter written out, as errors; who is attacked and who tests is decided anew at every step.
struct Run {
  const test::RandomNetwork& net;
  Matrix J;
  Matrix e;  // n x N

  double predicted(int j) const { return net.C.row(j).dot(net.A * e.col(j)); }  // C_j A e_j
  /// The innovation of an honest sensor.
  double innovation(int j, const Vector& w, double v) const {
    return -predicted(j) + net.C.row(j).dot(w) + v;
  }
  void step(const Vector& kappa, const Vector& w) {
    Matrix tilde = net.A * e;
    for (int j = 0; j < net.N(); ++j) tilde.col(j) += -w + net.C.row(j).transpose() * kappa(j);
    e = tilde * J.transpose();
  }
};

Matrix starts(test::Rng& rng, const test::RandomNetwork& net, double start) {
  Matrix e(net.n(), net.N());
  const Vector common = test::unit_vector(rng, net.n());
  const bool together = test::whole(rng, 0, 1) == 0;
  for (int i = 0; i < net.N(); ++i) e.col(i) = start * (together ? common : test::unit_vector(rng, net.n()));
  return e;
}

/// Noise that pushes one way, or anyhow, at its bound.
struct Drawn {
  Vector w;
  Vector v;
};
Drawn noise_at_bound(test::Rng& rng, const test::RandomNetwork& net, const Vector& toward) {
  Drawn noise{net.bw * (test::whole(rng, 0, 2) == 0 ? test::unit_vector(rng, net.n()) : Vector(-toward)),
              net.bv};
  for (int j = 0; j < net.N(); ++j) noise.v(j) *= net.C.row(j).dot(toward) < 0.0 ? -1.0 : 1.0;
  return noise;
}

void check_below(double value, double bound, double& largest) {
  CHECK(value <= bound * (1.0 + 1e-9) + 1e-12);
  if (bound > 0.0) largest = std::max(largest, value / bound);
}

}  // namespace

TEST_CASE(
    "T: no error, prediction or honest innovation is beyond the table, also while some agents are informed") {
  int steady = 0;
  int compared = 0;
  double largest = 0.0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    CAPTURE(k);
    test::Rng rng(kSeed + k);
    const auto net = test::random_network(rng, test::uniform(rng, 0.5, 1.1), test::whole(rng, 1, 12));
    const int s = test::whole(rng, 0, net.N() / 2);
    const int T = 60;
    const double start = std::pow(10.0, test::uniform(rng, -1.0, 1.0));
    const Kernels kernel = kernels(error_system(net.A, net.C, net.J()), test::whole(rng, 1, 30));
    TableOptions options{s, start, T, {}, test::whole(rng, 0, 1) == 0};
    if (test::whole(rng, 0, 2) == 0) options.beta = start * std::pow(10.0, test::uniform(rng, -1.0, 0.5));
    const Table t = table(kernel, options, net.bw, net.bv);
    steady += t.steady ? 1 : 0;
    for (int attempt = 0; attempt < 2; ++attempt) {
      Run run{net, net.J(), starts(rng, net, start)};
      std::vector<int> attacked = test::choose(rng, s, net.N());
      const Vector toward = test::unit_vector(rng, net.n());
      for (int now = 1; now <= T; ++now) {
        if (!options.fixed) attacked = test::choose(rng, s, net.N());
        const Drawn noise = noise_at_bound(rng, net, toward);
        Vector kappa = Vector::Zero(net.N());
        for (int j = 0; j < net.N(); ++j) {
          if (net.C.row(j).isZero()) continue;
          const double h = run.innovation(j, noise.w, noise.v(j));
          const double level = t.level(now, j);
          if (test::contains(attacked, j)) {
            const double push = net.C.row(j).dot(toward) < 0.0 ? -level : level;
            kappa(j) = test::whole(rng, 0, 4) == 0 ? 0.0 : test::whole(rng, 0, 4) == 0 ? -push : push;
            continue;
          }
          check_below(std::abs(h), t.H(now, j), largest);
          // A testing agent clips, one that is informed does not.
          kappa(j) = test::whole(rng, 0, 3) == 0 ? h : std::clamp(h, -level, level);
        }
        run.step(kappa, noise.w);
        for (int i = 0; i < net.N(); ++i) {
          check_below(run.e.col(i).norm(), t.d(now, i), largest);
          check_below(std::abs(run.predicted(i)), t.eta(now, i), largest);
          ++compared;
          if (now == T && t.steady) CHECK(run.e.col(i).norm() <= t.steady->d(i));
        }
      }
    }
  }
  CHECK(steady > 50);
  CHECK(steady < 390);
  std::cout << "T: 400 systems from seed " << kSeed << ", " << compared << " errors below, largest ratio "
            << largest << ", " << steady << " steady\n";
}

TEST_CASE(
    "T: what is called steady holds for ever; more attackers, noise and start give more; a fixed set gives "
    "less") {
  int accepted = 0;
  for (std::uint64_t k = 0; k < 150; ++k) {
    CAPTURE(k);
    test::Rng rng(kSeed + 1000 + k);
    const auto net = test::random_network(rng, test::uniform(rng, 0.5, 1.1), test::whole(rng, 1, 12));
    const Kernels kernel = kernels(error_system(net.A, net.C, net.J()), test::whole(rng, 3, 25));
    const int T = kernel.window() + 2 + test::whole(rng, 0, 30);
    const TableOptions options{test::whole(rng, 0, 2), 1.0, T, {}, false};
    const Table t = table(kernel, options, net.bw, net.bv);
    auto longer = options;
    longer.T = T + 200;
    const Table later = table(kernel, longer, net.bw, net.bv);
    CHECK(later.d.topRows(T + 1).isApprox(t.d));
    if (t.steady) {
      ++accepted;
      for (int now = T; now <= longer.T; ++now)
        CHECK((later.d.row(now).transpose().array() <= t.steady->d.array()).all());
    }
    auto more = options;
    more.s += 1;
    CHECK((table(kernel, more, net.bw, net.bv).d.array() >= t.d.array()).all());
    CHECK((table(kernel, options, 2.0 * net.bw, 2.0 * net.bv).d.array() >= t.d.array()).all());
    auto fixed = options;
    fixed.fixed = true;
    CHECK((table(kernel, fixed, net.bw, net.bv).d.array() <= t.d.array() * (1.0 + 1e-12)).all());
    // Homogeneous of degree one in noise and start.
    auto grown = options;
    grown.start *= 8.0;
    CHECK(table(kernel, grown, 8.0 * net.bw, 8.0 * net.bv).d.isApprox(8.0 * t.d, 1e-12));
  }
  CHECK(accepted > 40);
}

TEST_CASE("TG: errors of Gaussian runs stay below, and P is the law of the noise part") {
  int compared = 0;
  double largest = 0.0;
  for (std::uint64_t k = 0; k < 150; ++k) {
    CAPTURE(k);
    test::Rng rng(kSeed + 2000 + k);
    const auto net = test::random_network(rng, test::uniform(rng, 0.5, 1.0), test::whole(rng, 2, 12));
    const int s = test::whole(rng, 0, 2);
    const int T = 40;
    const Matrix root = 0.3 * test::normal_matrix(rng, net.n(), net.n());
    const Matrix Q = root * root.transpose();
    const Vector R = net.bv.cwiseAbs2();
    const double delta = 1e-9;
    const Kernels kernel = kernels(error_system(net.A, net.C, net.J()), 12);
    const GaussianTable t =
        gaussian_table(kernel, {s, 1.0, T, {}, false}, Q, R, two_sided(delta / (net.N() * T)));
    Run run{net, net.J(), starts(rng, net, 1.0)};
    for (int now = 1; now <= T; ++now) {
      const auto attacked = test::choose(rng, s, net.N());
      const Vector w = root * test::normal_matrix(rng, net.n(), 1);
      Vector kappa = Vector::Zero(net.N());
      for (int j = 0; j < net.N(); ++j) {
        if (net.C.row(j).isZero()) continue;
        const double h = run.innovation(j, w, test::normal_matrix(rng, 1, 1)(0) * std::sqrt(R(j)));
        if (test::contains(attacked, j)) {
          kappa(j) = t.table.level(now, j) * (net.C(j, 0) < 0.0 ? -1.0 : 1.0);
          continue;
        }
        check_below(std::abs(h), t.table.H(now, j), largest);
        kappa(j) = h;
      }
      run.step(kappa, w);
      const Vector bound = t.bound(now, delta);
      for (int i = 0; i < net.N(); ++i) {
        check_below(run.e.col(i).norm(), bound(i), largest);
        ++compared;
      }
    }
    // Without attack and start only the noise part is left; its second moments over steps are at most
    // trace(P).
    if (t.table.steady)
      CHECK((t.deviation.row(T).array() >= t.deviation.row(T - 1).array() * (1.0 - 1e-9)).all());
  }
  std::cout << "TG: 150 systems from seed " << kSeed + 2000 << ", " << compared
            << " errors below, largest ratio " << largest << '\n';
  CHECK(largest > 0.3);
}

TEST_CASE("TG: with nothing but noise, the errors' mean square is the trace of P") {
  test::Rng rng(77);
  const auto net = test::random_network(rng, 0.9, 4);
  const Vector R = net.bv.cwiseAbs2();
  const Matrix Q = 0.04 * Matrix::Identity(net.n(), net.n());
  const ErrorSystem system = error_system(net.A, net.C, net.J());
  Matrix P = Matrix::Zero(system.M.rows(), system.M.cols());
  for (int now = 1; now <= 6; ++now) P = next_covariance(system, P, Q, R);
  double sum = 0.0;
  const int trials = 20000;
  for (int trial = 0; trial < trials; ++trial) {
    Run run{net, net.J(), Matrix::Zero(net.n(), net.N())};
    for (int now = 1; now <= 6; ++now) {
      const Vector w = 0.2 * test::normal_matrix(rng, net.n(), 1);
      Vector kappa = Vector::Zero(net.N());
      for (int j = 0; j < net.N(); ++j)
        if (!net.C.row(j).isZero())
          kappa(j) = run.innovation(j, w, test::normal_matrix(rng, 1, 1)(0) * net.bv(j));
      run.step(kappa, w);
    }
    sum += run.e.squaredNorm();
  }
  CHECK(sum / trials == doctest::Approx(P.trace()).epsilon(0.03));
}

TEST_CASE("I: after all attackers are proved, no error is beyond the informed bound") {
  int compared = 0;
  double largest = 0.0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    CAPTURE(k);
    test::Rng rng(kSeed + 3000 + k);
    const auto net = test::random_network(rng, test::uniform(rng, 0.5, 1.1), test::whole(rng, 1, 12));
    const auto proved = test::choose(rng, test::whole(rng, 0, 3), net.N());
    Vector start(net.N());
    for (double& one : start) one = test::uniform(rng, 0.1, 5.0);
    const int steps = 25;
    const Gains bound = informed(error_system(net.A, net.C, net.J(), proved), start, steps, net.bw, net.bv);
    Run run{net, net.J(), starts(rng, net, 1.0) * start.asDiagonal()};
    const Vector toward = test::unit_vector(rng, net.n());
    for (int now = 1; now <= steps; ++now) {
      const Drawn noise = noise_at_bound(rng, net, toward);
      Vector kappa = Vector::Zero(net.N());
      for (int j = 0; j < net.N(); ++j)
        if (!test::contains(proved, j) && !net.C.row(j).isZero())
          kappa(j) = run.innovation(j, noise.w, noise.v(j));
      run.step(kappa, noise.w);
      for (int i = 0; i < net.N(); ++i) {
        check_below(run.e.col(i).norm(), bound(now - 1, i), largest);
        ++compared;
      }
    }
  }
  std::cout << "I: 300 systems from seed " << kSeed + 3000 << ", " << compared
            << " errors below, largest ratio " << largest << '\n';
  CHECK(largest > 0.5);
  CHECK(lists_complete(7, 5, 2) == 9);
  CHECK(lists_complete(7, 5, 10) == 7);
  CHECK(lists_complete(7, 0, 1) == 7);
}

TEST_CASE("tables refuse what they cannot hold for") {
  const Matrix A = Matrix::Identity(1, 1);
  const Matrix C = Matrix::Ones(3, 1);
  const Matrix J = Matrix::Constant(3, 3, 1.0 / 3.0);
  CHECK_THROWS_AS(error_system(A, 2.0 * C, J), InvalidInput);
  CHECK_THROWS_AS(error_system(A, C, 1.1 * J), InvalidInput);
  CHECK_THROWS_AS(error_system(A, C, J.topRows(2)), InvalidInput);
  CHECK_THROWS_AS(error_system(A, C * kNaN, J), InvalidInput);
  const std::vector<int> silent{3};
  CHECK_THROWS_AS(error_system(A, C, J, silent), InvalidInput);
  const ErrorSystem system = error_system(A, C, J);
  CHECK_THROWS_AS(kernels(system, 0), InvalidInput);
  CHECK_THROWS_AS(kernels(system, 2'000'000'000), InvalidInput);
  const Kernels k = kernels(system, 4);
  const Vector bv = Vector::Ones(3);
  CHECK_THROWS_AS(table(k, {-1, 1.0, 10, {}, false}, 0.1, bv), InvalidInput);
  CHECK_THROWS_AS(table(k, {1, -1.0, 10, {}, false}, 0.1, bv), InvalidInput);
  CHECK_THROWS_AS(table(k, {1, 1.0, 0, {}, false}, 0.1, bv), InvalidInput);
  CHECK_THROWS_AS(table(k, {1, 1.0, 10, -1.0, false}, 0.1, bv), InvalidInput);
  CHECK_THROWS_AS(table(k, {1, 1.0, 10, {}, false}, kNaN, bv), InvalidInput);
  CHECK_THROWS_AS(table(k, {1, 1.0, 10, {}, false}, 0.1, -bv), InvalidInput);
  CHECK_THROWS_AS(gaussian_table(k, {1, 1.0, 10, {}, false}, -A, bv, 3.0), InvalidInput);
  CHECK_THROWS_AS(gaussian_table(k, {1, 1.0, 10, {}, false}, A, bv, -3.0), InvalidInput);
  // One state, C = 1: M = 0, T forgets everything in one step.
  const Table t = table(k, {0, 5.0, 10, {}, false}, 0.1, bv);
  CHECK(t.d(1, 0) == doctest::Approx(1.0));
  REQUIRE(t.steady);
  // Too many attackers: it grows, is never called steady, and ends at infinity, not at NaN.
  const Table grows = table(k, {3, 5.0, 3000, {}, false}, 0.1, bv);
  CHECK_FALSE(grows.steady);
  CHECK(grows.d(3000, 0) == kInfinity);
  CHECK_FALSE(grows.d.array().isNaN().any());
}
