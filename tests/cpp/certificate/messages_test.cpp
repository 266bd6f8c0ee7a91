// SPDX-License-Identifier: Apache-2.0
// A search for an error beyond what messages carry: relays, propagation, recovery after losses, two numbers.
#include <doctest/doctest.h>

#include <iostream>

#include "garrison/certificate/order_rule.hpp"
#include "garrison/certificate/propagate.hpp"
#include "garrison/certificate/quantiles.hpp"
#include "garrison/certificate/recovery.hpp"
#include "garrison/certificate/relay.hpp"
#include "garrison/certificate/two_numbers.hpp"
#include "random_network.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {
constexpr std::uint64_t kSeed = 20261128;
}

TEST_CASE("R: averages of estimates that keep their bounds keep the relayed bound, whatever the weights") {
  test::Rng rng(kSeed);
  double largest = 0.0;
  for (int k = 0; k < 5000; ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 4);
    const int q = test::whole(rng, 1, 6);
    const Vector x = test::normal_matrix(rng, n, 1);
    Matrix estimates(n, q);
    Vector bounds(q);
    Vector weights = test::normal_matrix(rng, q, 1);
    weights /= weights.sum();
    const Vector toward = test::unit_vector(rng, n);
    for (int j = 0; j < q; ++j) {
      bounds(j) = test::uniform(rng, 0.0, 2.0);
      const Vector error =
          k % 2 == 0 ? Vector(weights(j) < 0.0 ? -toward : toward) : test::unit_vector(rng, n);
      estimates.col(j) = x + bounds(j) * error;
    }
    Region r = averaged(weights, estimates, bounds);
    const double error = (r.center - x).norm();
    CHECK(error <= r.radius * (1.0 + 1e-9) + 1e-9 * weights.norm());
    if (r.radius > 0.0) largest = std::max(largest, error / r.radius);
    // A sender without a bound takes one way away, never the answer of the others.
    if (q > 1) {
      bounds(0) = k % 3 == 0 ? kNaN : kInfinity;
      r = averaged(weights, estimates, bounds);
      CHECK(r.answered());
      CHECK(error <= r.radius * (1.0 + 1e-9) + 1e-9 * weights.norm());
    }
  }
  CHECK(largest > 0.999);
  CHECK(after_injection(0.5, 2.0, 0.1, -3.0) == doctest::Approx(4.1));
  CHECK_THROWS_AS(averaged(Vector::Constant(2, 0.4), Matrix::Zero(1, 2), Vector::Ones(2)), InvalidInput);
  CHECK_THROWS_AS(averaged(Vector::Constant(2, 0.5), Matrix::Zero(1, 2), -Vector::Ones(2)), InvalidInput);
  CHECK_THROWS_AS(after_injection(1.0, kNaN, 0.0, 0.0), InvalidInput);
}

TEST_CASE("R: the order rule holds with f lying senders") {
  test::Rng rng(kSeed + 1);
  int answered = 0;
  for (int k = 0; k < 5000; ++k) {
    const int q = test::whole(rng, 1, 8);
    const int f = test::whole(rng, 0, 3);
    const double truth = test::uniform(rng, 0.0, 5.0);
    const auto liars = test::choose(rng, f, q);
    Vector values(q);
    for (int j = 0; j < q; ++j)
      values(j) =
          test::contains(liars, j) ? test::uniform(rng, 0.0, truth) : truth + test::uniform(rng, 0.0, 1.0);
    if (test::whole(rng, 0, 5) == 0) values(test::whole(rng, 0, q - 1)) = kNaN;  // says nothing
    const double bound = order_rule(values, f);
    CHECK(bound >= truth);
    answered += std::isfinite(bound) ? 1 : 0;
  }
  CHECK(answered > 2000);
  CHECK_THROWS_AS(order_rule(Vector::Ones(2), -1), InvalidInput);
}

TEST_CASE("R: a region of some steps ago holds today") {
  test::Rng rng(kSeed + 2);
  double largest = 0.0;
  int outside = 0;
  const double delta = 0.01;
  const int trials = 4000;
  for (int k = 0; k < trials; ++k) {
    const int n = test::whole(rng, 1, 3);
    const Matrix A = Matrix::Identity(n, n) + 0.3 * test::normal_matrix(rng, n, n);
    const double bw = test::uniform(rng, 0.0, 0.5);
    const Matrix root = 0.3 * test::normal_matrix(rng, n, n);
    const int age = test::whole(rng, 0, 5);
    const Region then{test::normal_matrix(rng, n, 1), test::uniform(rng, 0.0, 2.0), {}};
    Vector x = then.center + then.radius * test::unit_vector(rng, n);
    Vector g = then.center;  // no error at the start: only the noise is left
    for (int t = 0; t < age; ++t) {
      x = A * x + bw * test::unit_vector(rng, n);
      g = A * g + root * test::normal_matrix(rng, n, 1);
    }
    const Region now = Propagation::bounded(A, 5, bw).age(then, age);
    CHECK((x - now.center).norm() <= now.radius * (1.0 + 1e-9) + 1e-12);
    if (now.radius > 0.0) largest = std::max(largest, (x - now.center).norm() / now.radius);
    const Region exact{then.center, 0.0, {}};
    const Region gauss = Propagation::gaussian(A, 5, root * root.transpose(), delta).age(exact, age);
    outside += (g - gauss.center).norm() > gauss.radius * (1.0 + 1e-9) ? 1 : 0;
  }
  CHECK(largest > 0.999);
  CHECK(outside < 2.0 * delta * trials);
  CHECK(outside > 0);
  const Region refuted{Vector::Zero(1), kNaN, {}};
  CHECK(Propagation::bounded(Matrix::Ones(1, 1), 2, 0.1).age(refuted, 2).refuted());
  CHECK_THROWS_AS(Propagation::bounded(Matrix::Ones(1, 1), 2, 0.1).age(refuted, 3), InvalidInput);
  CHECK_THROWS_AS(Propagation::bounded(Matrix::Ones(1, 1), -1, 0.1), InvalidInput);
  CHECK_THROWS_AS(Propagation::gaussian(Matrix::Ones(1, 1), 1, -Matrix::Ones(1, 1), 0.1), InvalidInput);
}

namespace {

/// One agent of the run with losses: estimate error, what it can prove of it, and what its messages carry.
struct Node {
  Vector e;
  double bound;  // on ||e|| at the end of the last step
  LossState state;
  double relayed = 0.0;  // in this step's rounds
  bool hit = false;
};

struct LossyRun {
  const test::RandomNetwork& net;
  const Table& nominal;
  const Recovery& recovery;
  std::vector<Node> nodes;
  int recovering = 0;
  int compared = 0;
  double largest = 0.0;

  /// One step with every directed message of every round lost with probability p.
  void step(test::Rng& rng, int t, double p, const std::vector<int>& attacked, const Vector& toward) {
    const Vector w = net.bw * test::unit_vector(rng, net.n());
    const double norm_A = spectral_norm(net.A);
    for (int j = 0; j < net.N(); ++j) {
      Node& node = nodes[static_cast<std::size_t>(j)];
      node.hit = false;
      const double predicted = net.C.row(j).dot(net.A * node.e);
      double kappa = 0.0;
      if (!net.C.row(j).isZero()) {
        const double level = nominal.level(t, j) + recovery.level_excess(j, node.state, t - 1);
        if (test::contains(attacked, j)) {
          kappa = net.C.row(j).dot(toward) < 0.0 ? -level : level;
        } else {
          kappa = -predicted + net.C.row(j).dot(w) + test::sign(rng) * net.bv(j);
          CHECK(std::abs(kappa) <= level * (1.0 + 1e-9) + 1e-12);  // nobody honest is ever clipped
        }
      }
      node.e = net.A * node.e - w + net.C.row(j).transpose() * kappa;
      node.relayed = after_injection(norm_A, node.bound, net.bw, kappa);
    }
    for (int round = 0; round < net.rounds; ++round) exchange(rng, t, p);
    for (int i = 0; i < net.N(); ++i) close(i, t);
  }

  void exchange(test::Rng& rng, int t, double p) {
    const std::vector<Node> sent = nodes;
    for (int i = 0; i < net.N(); ++i) {
      Node& node = nodes[static_cast<std::size_t>(i)];
      double own = 1.0;
      node.e.setZero();
      std::vector<std::pair<double, int>> arrived;
      for (int j = 0; j < net.N(); ++j) {
        if (j == i || net.W(i, j) == 0.0) continue;
        if (test::uniform(rng, 0.0, 1.0) < p) {
          node.hit = true;
          continue;
        }
        const Node& other = sent[static_cast<std::size_t>(j)];
        arrived.emplace_back(net.W(i, j), j);
        own -= net.W(i, j);
        node.state = recovery.merge(node.state, other.state, t - 1);
        node.hit = node.hit || other.hit;
      }
      arrived.emplace_back(own, i);
      for (const auto& [weight, j] : arrived) node.e += weight * sent[static_cast<std::size_t>(j)].e;
      RelayedBound bound;
      for (const auto& [weight, j] : arrived)
        bound.add(weight, (node.e - sent[static_cast<std::size_t>(j)].e).norm(),
                  sent[static_cast<std::size_t>(j)].relayed);
      node.relayed = bound.value();
    }
  }

  void close(int i, int t) {
    Node& node = nodes[static_cast<std::size_t>(i)];
    if (node.hit) {
      node.state = Recovery::lost(t, node.relayed, nominal.d(t, i));
      node.bound = node.relayed;
    } else {
      const double excess = recovery.error_excess(i, node.state, t);
      recovering += excess > 0.0 ? 1 : 0;
      const double recovered = nominal.d(t, i) + excess;
      CHECK(node.e.norm() <= recovered * (1.0 + 1e-9) + 1e-12);
      largest = std::max(largest, node.e.norm() / recovered);
      node.bound = std::min(node.relayed, recovered);
    }
    CHECK(node.e.norm() <= node.bound * (1.0 + 1e-9) + 1e-12);
    ++compared;
  }
};

}  // namespace

TEST_CASE(
    "L and R: through losses and after them no error is beyond its bound and nobody honest is clipped") {
  int compared = 0;
  int recovering = 0;
  double largest = 0.0;
  for (std::uint64_t k = 0; k < 250; ++k) {
    CAPTURE(k);
    test::Rng rng(kSeed + 4000 + k);
    const auto net = test::random_network(rng, test::uniform(rng, 0.5, 1.05), test::whole(rng, 1, 8));
    const int s = test::whole(rng, 0, 2);
    const int T = 60;
    const double start = test::uniform(rng, 0.1, 5.0);
    const Kernels kernel = kernels(error_system(net.A, net.C, net.J()), test::whole(rng, 5, 20));
    const Table nominal = table(kernel, {s, start, T, {}, false}, net.bw, net.bv);
    if (!(nominal.d.row(T).maxCoeff() < 1e6)) continue;
    const Recovery recovery(kernel, s);
    LossyRun run{net, nominal, recovery, {}};
    for (int i = 0; i < net.N(); ++i)
      run.nodes.push_back({start * test::unit_vector(rng, net.n()), start, {}});
    const Vector toward = test::unit_vector(rng, net.n());
    const double p = test::uniform(rng, 0.02, 0.4);
    for (int t = 1; t <= T; ++t) {
      const bool outage = (t > 8 && t < 14) || (t > 30 && t < 33);
      run.step(rng, t, outage ? p : 0.0, test::choose(rng, s, net.N()), toward);
    }
    compared += run.compared;
    recovering += run.recovering;
    largest = std::max(largest, run.largest);
  }
  CHECK(recovering > 5000);
  std::cout << "L: 250 systems from seed " << kSeed + 4000 << ", " << compared << " errors below, "
            << recovering << " while recovering, largest ratio " << largest << '\n';
}

TEST_CASE("L: Lemma 2: a restart dominates what it came from") {
  for (std::uint64_t k = 0; k < 60; ++k) {
    test::Rng rng(kSeed + 5000 + k);
    const auto net = test::random_network(rng, test::uniform(rng, 0.5, 1.1), test::whole(rng, 1, 8));
    const Recovery recovery(kernels(error_system(net.A, net.C, net.J()), 15), test::whole(rng, 0, 2));
    const int K = recovery.window();
    for (int k1 = 0; k1 <= K; ++k1)
      for (int k2 = 0; k1 + k2 <= K; ++k2)
        for (int i = 0; i < net.N(); ++i) {
          const double most = recovery.rb().row(k1).maxCoeff();
          CHECK(recovery.rb()(k1 + k2, i) <= most * recovery.rb()(k2, i) * (1.0 + 1e-9) + 1e-12);
          CHECK(recovery.re()(k1 + k2, i) <= most * recovery.re()(k2, i) * (1.0 + 1e-9) + 1e-12);
        }
    const LossState p{3, 1.0};
    const LossState q{7, 0.5};
    const LossState both = recovery.merge(p, q, 9);
    for (int i = 0; i < net.N(); ++i)
      for (int t = 9; t < 40; ++t) {
        CHECK(recovery.error_excess(i, both, t) >= recovery.error_excess(i, p, t) * (1.0 - 1e-9));
        CHECK(recovery.error_excess(i, both, t) >= recovery.error_excess(i, q, t) * (1.0 - 1e-9));
      }
    CHECK(recovery.error_excess(0, {0, 0.0}, 1000) == 0.0);
  }
}

TEST_CASE("M: with links that fail unknown to everybody, no error is beyond rho + q p") {
  int compared = 0;
  double largest = 0.0;
  for (std::uint64_t k = 0; k < 250; ++k) {
    CAPTURE(k);
    test::Rng rng(kSeed + 6000 + k);
    const auto net = test::random_network(rng, test::uniform(rng, 0.5, 1.0), test::whole(rng, 1, 10));
    const int N = net.N();
    const int s = test::whole(rng, 0, 2);
    Matrix e(net.n(), N);
    for (int i = 0; i < N; ++i) e.col(i) = test::uniform(rng, 0.0, 3.0) * test::unit_vector(rng, net.n());
    const Vector mean = e.rowwise().mean();
    TwoNumbers m(net.A, net.C, s, mean.norm(), (e.colwise() - mean).norm(), net.bw, net.bv);
    const Vector toward = test::unit_vector(rng, net.n());
    for (int t = 1; t <= 15; ++t) {
      Matrix J = Matrix::Identity(N, N);
      for (int round = 0; round < net.rounds; ++round) {  // acknowledged: a link fails both ways
        Matrix W = Matrix::Identity(N, N);
        for (int i = 0; i < N; ++i)
          for (int j = i + 1; j < N; ++j) {
            if (net.W(i, j) == 0.0 || test::uniform(rng, 0.0, 1.0) < 0.3) continue;
            W(i, j) = W(j, i) = net.W(i, j);
            W(i, i) -= net.W(i, j);
            W(j, j) -= net.W(i, j);
          }
        J = W * J;
      }
      const double gamma = spectral_norm(J - Matrix::Constant(N, N, 1.0 / N));
      const Vector w = -net.bw * toward;
      const auto attacked = test::choose(rng, s, N);
      Matrix tilde = net.A * e;
      for (int j = 0; j < N; ++j) {
        tilde.col(j) -= w;
        if (net.C.row(j).isZero()) continue;
        const double level = m.level(j);
        const double out = net.C.row(j).dot(toward) < 0.0 ? -1.0 : 1.0;
        double kappa = out * level;
        if (!test::contains(attacked, j)) {
          kappa = net.C.row(j).dot(w - net.A * e.col(j)) + out * net.bv(j);
          CHECK(std::abs(kappa) <= level * (1.0 + 1e-9) + 1e-12);
        }
        tilde.col(j) += net.C.row(j).transpose() * kappa;
      }
      e = tilde * J.transpose();
      const double bound = m.step(gamma);
      CHECK(e.rowwise().mean().norm() <= m.rho() * (1.0 + 1e-9) + 1e-12);
      for (int i = 0; i < N; ++i) {
        CHECK(e.col(i).norm() <= bound * (1.0 + 1e-9) + 1e-12);
        largest = std::max(largest, e.col(i).norm() / bound);
        ++compared;
      }
    }
  }
  std::cout << "M: 250 systems from seed " << kSeed + 6000 << ", " << compared
            << " errors below, largest ratio " << largest << '\n';
  CHECK(largest > 0.3);
  const Matrix A = Matrix::Identity(1, 1);
  const Vector bv = Vector::Ones(2);
  CHECK_THROWS_AS(TwoNumbers(A, Matrix::Ones(2, 1), -1, 1.0, 0.0, 0.1, bv), InvalidInput);
  CHECK_THROWS_AS(TwoNumbers(A, 2.0 * Matrix::Ones(2, 1), 1, 1.0, 0.0, 0.1, bv), InvalidInput);
  CHECK_THROWS_AS(TwoNumbers(A, Matrix::Ones(2, 1), 1, 1.0, kNaN, 0.1, bv), InvalidInput);
  CHECK_THROWS_AS(TwoNumbers(A, Matrix::Ones(2, 1), 1, 1.0, 0.0, 0.1, bv).step(-1.0), InvalidInput);
}
