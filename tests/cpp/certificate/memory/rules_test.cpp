// SPDX-License-Identifier: Apache-2.0
// Rules around the windows: boxes combined, gaps, clipped observers, meters, ranges, liars.
#include <doctest/doctest.h>

#include <iostream>

#include "../random_network.hpp"
#include "garrison/certificate/memory/byzantine.hpp"
#include "garrison/certificate/memory/cells.hpp"
#include "garrison/certificate/memory/leverage_window.hpp"
#include "garrison/certificate/memory/meters.hpp"
#include "garrison/certificate/memory/observer_table.hpp"
#include "garrison/certificate/memory/range_row.hpp"
#include "garrison/certificate/propagate.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {
constexpr std::uint64_t kSeed = 20261201;
}

TEST_CASE("boxes combined contain the truth as long as at most s are wrong") {
  test::Rng rng(kSeed);
  int answered = 0;
  for (int k = 0; k < 2000; ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 3);
    const int g = test::whole(rng, 1, 6);
    const int s = test::whole(rng, 0, 2);
    const Vector x = 3.0 * test::normal_matrix(rng, n, 1);
    const std::vector<int> wrong = test::choose(rng, test::whole(rng, 0, s), g);
    std::vector<Region> regions;
    for (int j = 0; j < g; ++j) {
      const Vector box = test::normal_matrix(rng, n, 1).cwiseAbs();
      Vector center = x;
      for (Eigen::Index i = 0; i < n; ++i) center(i) += test::sign(rng) * box(i);  // at the edge
      if (test::contains(wrong, j)) center += 10.0 * test::unit_vector(rng, n);
      regions.push_back({center, box.norm(), box});
      if (!test::contains(wrong, j) && test::whole(rng, 0, 5) == 0)
        regions.back() = Region{};  // says nothing
      if (test::contains(wrong, j) && test::whole(rng, 0, 3) == 0) regions.back().radius = kNaN;
    }
    bool any = false;
    for (const Region& region : regions) any = any || region.answered();
    if (!any) {
      CHECK_THROWS_AS(cells(regions, s), InvalidInput);
      continue;
    }
    const Box hull = cells(regions, s);
    CHECK((hull.lo.array() <= x.array()).all());
    CHECK((hull.hi.array() >= x.array()).all());
    answered += std::isfinite(hull.lo(0)) ? 1 : 0;
    const Vector estimate = x + test::normal_matrix(rng, n, 1);
    CHECK((order_rule(regions, estimate, s).array() >= (estimate - x).cwiseAbs().array() * (1.0 - 1e-12))
              .all());
    if (!wrong.empty()) continue;
    const Region both = intersection(regions);
    REQUIRE(both.answered());
    CHECK(((x - both.center).cwiseAbs().array() <= both.box.array() * (1.0 + 1e-12) + 1e-12).all());
    for (const Region& region : regions)
      if (region.answered()) CHECK((both.box.array() <= region.box.array() * (1.0 + 1e-9) + 1e-9).all());
  }
  CHECK(answered > 500);
  const std::vector<Region> apart{{Vector::Zero(1), 1.0, {}}, {Vector::Constant(1, 5.0), 1.0, {}}};
  CHECK(intersection(apart).refuted());
  CHECK(std::isnan(cells(apart, 0).lo(0)));
  CHECK_THROWS_AS(cells({}, 0), InvalidInput);
  CHECK_THROWS_AS(cells(apart, -1), InvalidInput);
}

TEST_CASE("a region that ages holds coordinate by coordinate, and is reached by the worst noise") {
  test::Rng rng(kSeed + 1);
  double largest = 0.0;
  for (int k = 0; k < 1000; ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 3);
    const int q = test::whole(rng, 1, n);
    const int steps = test::whole(rng, 1, 12);
    const Matrix A = Matrix::Identity(n, n) + 0.2 * test::normal_matrix(rng, n, n);
    const Matrix Gam = 0.3 * test::normal_matrix(rng, n, q);
    const Matrix root = Matrix::Identity(n, n) + 0.3 * test::normal_matrix(rng, n, n);
    const Region then = ellipsoid(test::normal_matrix(rng, n, 1), root * root.transpose(), 1.5);
    const double bw = 0.4;
    const Region now = Propagation::bounded_entries(A, steps, Gam, bw).age(then, steps);
    Matrix power = Matrix::Identity(n, n);
    for (int t = 0; t < steps; ++t) power = A * power;
    const int i = test::whole(rng, 0, n - 1);
    // The start and the noise that move coordinate i most.
    Vector d = 1.5 * root * (root.transpose() * power.row(i).transpose()).normalized();
    if (k % 2 == 1) d = 1.5 * root * test::unit_vector(rng, n);
    Vector x = then.center + d;
    for (int t = 0; t < steps; ++t) {
      Matrix rest = Matrix::Identity(n, n);
      for (int more = t + 1; more < steps; ++more) rest = A * rest;
      const Vector push = (rest * Gam).row(i).transpose();
      x = A * x + Gam * bw * push.unaryExpr([](double g) { return g < 0.0 ? -1.0 : 1.0; });
    }
    const Vector error = x - now.center;
    CHECK((error.cwiseAbs().array() <= now.box.array() * (1.0 + 1e-9)).all());
    CHECK(error.norm() <= now.radius * (1.0 + 1e-9));
    CHECK(error.dot(Eigen::LDLT<Matrix>(now.shape).solve(error)) <= now.stretch * now.stretch * (1.0 + 1e-6));
    if (k % 2 == 0) CHECK(std::abs(error(i)) == doctest::Approx(now.box(i)));  // exact
    largest = std::max(largest, std::abs(error(i)) / now.box(i));
  }
  CHECK(largest > 0.999999);
  // A gap of a double integrator: the box grows with the time, not with ||A||^k.
  Matrix A(2, 2);
  A << 1.0, 0.1, 0.0, 1.0;
  Vector Gam(2);
  Gam << 0.005, 0.1;
  const Region start = ellipsoid(Vector::Zero(2), Matrix::Identity(2, 2), 1.0);
  const Region after = Propagation::bounded_entries(A, 200, Gam, 0.6).age(start, 200);
  CHECK(after.box(0) == doctest::Approx(140.0).epsilon(0.01));
  CHECK(std::pow(Eigen::JacobiSVD<Matrix>(A).singularValues()(0), 200) > 10000.0);
}

TEST_CASE("the clipped observer stays inside its table, whoever lies in which step") {
  test::Rng rng(kSeed + 2);
  int finite = 0;
  double largest = 0.0;
  for (int k = 0; k < test::tried(1200); ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 3);
    const int m = test::whole(rng, 3, 8);
    Matrix A = Matrix::Identity(n, n) + 0.2 * test::normal_matrix(rng, n, n);
    A *= test::uniform(rng, 0.8, 1.0) / Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
    const Matrix C = test::normal_matrix(rng, m, n);
    const Matrix L =
        test::uniform(rng, 0.3, 1.0) * (C.transpose() * C + Matrix::Identity(n, n)).inverse() * C.transpose();
    const Matrix Gam = 0.2 * test::normal_matrix(rng, n, n);
    const Vector bv = Vector::Constant(m, 0.1);
    const int T = 30;
    const ObserverTable t = observer_table(A, C, L, Gam, bv, {}, {1, 0.3, 0.5, T, 10});
    Vector e = 0.5 * test::unit_vector(rng, n);  // xhat - x
    for (int step = 1; step <= T; ++step) {
      if (!std::isfinite(t.d(step, n))) break;
      const Vector w = Gam * 0.3 * test::unit_vector(rng, n);
      const int liar = test::whole(rng, 0, m - 1);
      const Vector before = A * e - w;
      Vector kappa(m);
      for (int r = 0; r < m; ++r) {
        const double honest = -C.row(r).dot(before) + test::sign(rng) * bv(r);
        CHECK(std::abs(honest) <= t.level(step, r) * (1.0 + 1e-9));
        kappa(r) = r == liar ? (L.col(r).dot(before) < 0.0 ? -1.0 : 1.0) * t.level(step, r) : honest;
      }
      e = before + L * kappa;
      CHECK((e.cwiseAbs().array() <= t.d.row(step).head(n).transpose().array() * (1.0 + 1e-9)).all());
      CHECK(e.norm() <= t.d(step, n) * (1.0 + 1e-9));
      largest = std::max(largest, e.norm() / t.d(step, n));
    }
    finite += std::isfinite(t.d(T, n)) ? 1 : 0;
  }
  std::cout << "observer: " << finite << " finite tables, largest error/bound " << largest << "\n";
  CHECK(finite > test::tried(1000));
  CHECK(largest > 0.5);
  const Matrix one = Matrix::Ones(1, 1);
  CHECK_THROWS_AS(observer_table(one, one, one, one, Vector::Ones(2), {}, {}), InvalidInput);
  CHECK_THROWS_AS(observer_table(one, one, one, one, Vector::Ones(1), {}, {-1, 0, 0, 1, 1}), InvalidInput);
}

TEST_CASE(
    "the smallest undetectable attack is what trying all sets finds, and the leverage bound is below it") {
  test::Rng rng(kSeed + 3);
  int found = 0;
  for (int k = 0; k < test::tried(3000); ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 4);
    const int m = test::whole(rng, n, 9);
    Matrix H = test::normal_matrix(rng, m, n);
    for (int r = 0; r < m; ++r)
      for (int i = 0; i < n; ++i)
        if (test::whole(rng, 0, 1) == 0) H(r, i) = 0.0;
    const auto rank = [&](unsigned without) {
      Matrix rest = Matrix::Zero(m, n);
      for (int r = 0; r < m; ++r)
        if (((without >> r) & 1U) == 0) rest.row(r) = H.row(r);
      return Eigen::FullPivLU<Matrix>(rest).rank();
    };
    if (rank(0) < n || H.rowwise().norm().minCoeff() == 0.0) {
      CHECK_THROWS_AS(smallest_undetectable(H, 3), InvalidInput);
      continue;
    }
    int smallest = m;
    for (unsigned set = 1; set < (1U << m); ++set)
      if (rank(set) < n) smallest = std::min(smallest, static_cast<int>(__builtin_popcount(set)));
    const SmallestAttack attack = smallest_undetectable(H, m);
    REQUIRE(attack.size.has_value());
    CHECK(*attack.size == smallest);
    CHECK(attack.searched == smallest - 1);
    unsigned example = 0;
    for (const int r : attack.example) example |= 1U << r;
    CHECK(rank(example) < n);
    const Meters by_leverage = meters(H);
    CHECK(by_leverage.removable < smallest);
    for (int r = 0; r < m; ++r) CHECK((rank(1U << r) < n) == test::contains(by_leverage.critical, r));
    ++found;
  }
  std::cout << "meters: " << found << " systems\n";
  CHECK(found > test::tried(1000));
  CHECK_THROWS_AS(meters(Matrix::Zero(2, 2)), InvalidInput);
}

TEST_CASE("a linearised range is a legal row inside its ball") {
  test::Rng rng(kSeed + 4);
  double largest = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const int n = test::whole(rng, 2, 3);
    const Vector p = 3.0 * test::normal_matrix(rng, n, 1);
    const Vector c0 = 3.0 * test::normal_matrix(rng, n, 1);
    const double rho = test::uniform(rng, 0.0, 1.0);
    const auto row = range_row(p, c0, rho);
    if (!row) {
      CHECK((c0 - p).norm() <= rho);
      continue;
    }
    const Vector x = c0 + rho * test::unit_vector(rng, n);
    const double error = std::abs((x - p).norm() - (row->offset + row->h.dot(x)));
    CHECK(error <= row->remainder * (1.0 + 1e-9) + 1e-12);
    if (row->remainder > 1e-6) largest = std::max(largest, error / row->remainder);
  }
  CHECK(largest > 0.5);
  CHECK_FALSE(range_row(Vector::Zero(2), Vector::Zero(2), 0.0).has_value());
  CHECK_THROWS_AS(range_row(Vector::Zero(2), Vector::Zero(3), 0.1), InvalidInput);
}

TEST_CASE("a flooded number is believed only when no f liars can have made it up") {
  test::Rng rng(kSeed + 5);
  int believed = 0;
  for (int k = 0; k < 2000; ++k) {
    CAPTURE(k);
    const int liars = test::whole(rng, 0, 2);
    std::vector<Path> paths;
    for (int more = test::whole(rng, 1, 6); more > 0; --more) {
      Path path{0};
      for (const int relay : test::choose(rng, test::whole(rng, 1, 3), 6)) path.push_back(relay + 1);
      paths.push_back(path);
    }
    // Can some set of `liars` relays be on every path?
    bool forged = false;
    for (unsigned set = 0; set < (1U << 6); ++set) {
      if (__builtin_popcount(set) > liars) continue;
      bool all = true;
      for (const Path& path : paths) {
        bool through = false;
        for (std::size_t h = 1; h < path.size(); ++h) through = through || ((set >> (path[h] - 1)) & 1U) != 0;
        all = all && through;
      }
      forged = forged || all;
    }
    const bool yes = accepted(paths, liars);
    if (yes) CHECK_FALSE(forged);
    believed += yes ? 1 : 0;
    paths.push_back({0});
    CHECK(accepted(paths, liars));
  }
  CHECK(believed > 200);
  CHECK_THROWS_AS(accepted({{}}, 1), InvalidInput);
  CHECK_THROWS_AS(accepted({{0}, {1}}, 1), InvalidInput);
  CHECK_THROWS_AS(accepted({{0}}, -1), InvalidInput);
}
