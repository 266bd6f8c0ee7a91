// SPDX-License-Identifier: Apache-2.0
// A search for a certificate with memory that does not contain the truth, or accuses somebody honest.
#include <doctest/doctest.h>

#include <iostream>
#include <map>
#include <string>

#include "garrison/certificate/leverage_ball.hpp"
#include "garrison/certificate/memory/anytime_window.hpp"
#include "garrison/certificate/memory/hull_window.hpp"
#include "garrison/certificate/memory/leverage_window.hpp"
#include "garrison/certificate/memory/subsets_window.hpp"
#include "garrison/certificate/propagate.hpp"
#include "random_window.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

constexpr std::uint64_t kSeed = 20261129;

struct Tally {
  int sets = 0, answered = 0, proved = 0;
  double largest = 0.0;
};

void check(const test::WindowCase& d, const WindowWitness& w, Tally& tally) {
  ++tally.sets;
  CHECK_FALSE(w.region.refuted());
  for (const Proof& proof : w.proofs) {
    bool lies = false;
    for (int k = 0; k < d.steps; ++k)
      lies = lies || ((proof.step == kAlways || proof.step == k) &&
                      test::contains(d.attacked[static_cast<std::size_t>(k)], proof.source));
    CHECK(lies);
    ++tally.proved;
  }
  if (!w.region.answered()) return;
  ++tally.answered;
  const Vector error = d.x.back() - w.region.center;
  const double slack = 1e-9 * (1.0 + d.x.back().norm());
  CHECK(error.norm() <= w.region.radius * (1.0 + 1e-8) + slack);
  CHECK((error.cwiseAbs().array() <= w.region.box.array() * (1.0 + 1e-8) + slack).all());
  CHECK(w.region.radius <= w.region.box.norm() * (1.0 + 1e-12));
  // The ellipsoid, where it has a volume.
  const Vector scale = w.region.shape.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Eigen::SelfAdjointEigenSolver<Matrix> shape(
      Matrix(scale.cwiseInverse().asDiagonal() * w.region.shape * scale.cwiseInverse().asDiagonal()));
  if (shape.eigenvalues()(0) > 1e-9 * shape.eigenvalues()(d.n - 1)) {
    const double reach = (shape.operatorInverseSqrt() * error.cwiseQuotient(scale)).norm();
    CHECK(reach <= w.region.stretch * (1.0 + 1e-6) + 1e-6);
  }
  for (Eigen::Index i = 0; i < error.size(); ++i)
    if (w.region.box(i) > 1e-9) tally.largest = std::max(tally.largest, std::abs(error(i)) / w.region.box(i));
}

void print(const char* name, const Tally& t) {
  std::cout << name << ": " << t.sets << " windows, " << t.answered << " answers, " << t.proved
            << " proofs, largest error/box " << t.largest << "\n";
}

}  // namespace

TEST_CASE("W2M, W3M and A contain the truth at the edge of their events, and accuse nobody honest") {
  test::Rng rng(kSeed);
  Tally leverage;
  Tally moving;
  Tally subsets;
  Tally search;
  int widths = 0;
  for (int k = 0; k < test::tried(3600); ++k) {
    CAPTURE(k);
    test::WindowCase d = test::draw_window(rng, k % 3 == 0, false);
    test::play(rng, d);
    const Window w = d.window();
    WindowAssumption a{d.s, d.levels, d.moving, {}, {}};
    const WindowWitness by_leverage = leverage_window(w, a);
    check(d, by_leverage, d.moving ? moving : leverage);
    if (d.moving) continue;
    const WindowWitness by_subsets = subsets_window(w, a);
    check(d, by_subsets, subsets);
    // Design time: nothing the attackers say makes it wider.
    const Vector width = subsets_window_width(w, a);
    if (width.allFinite()) {
      ++widths;
      CHECK(by_subsets.region.answered());
      CHECK((by_subsets.region.box.array() <= width.array() * (1.0 + 1e-9)).all());
    }
    for (const int leaves : {1, 4, 30}) {
      CAPTURE(leaves);
      const WindowWitness by_search = anytime_window(w, a, leaves);
      check(d, by_search, search);
      if (leaves == 1 && by_leverage.region.answered() && by_search.count == 1)
        CHECK(by_search.region.radius == by_leverage.region.radius);
    }
    // What is known of the sources only helps, and stays true.
    const std::vector<int> known(d.attacked.front().begin(),
                                 d.attacked.front().begin() + (d.attacked.front().empty() ? 0 : 1));
    a.proved = known;
    check(d, leverage_window(w, a), leverage);
    check(d, subsets_window(w, a), subsets);
  }
  print("W2M", leverage);
  print("W2M, moving sets", moving);
  print("W3M", subsets);
  print("A", search);
  std::cout << "W3D: " << widths << " finite widths\n";
  for (const Tally* t : {&leverage, &moving, &subsets, &search}) {
    CHECK(t->answered > test::tried(800));
    CHECK(t->largest > 0.9);  // the events are reached: the test can fail
  }
  CHECK(leverage.proved > test::tried(100));
  CHECK(moving.proved > test::tried(50));
  CHECK(subsets.proved > test::tried(100));
  CHECK(widths > test::tried(1000));
}

TEST_CASE("with Gaussian noise W2M, W3M and A fail less often than they say") {
  test::Rng rng(kSeed + 4);
  constexpr double kDelta = 0.05;
  std::map<std::string, std::pair<int, int>> tally;  // answers, failures
  for (int k = 0; k < test::tried(4000); ++k) {
    test::WindowCase d = test::draw_window(rng, k % 2 == 0, false);
    d.random = true;
    d.levels = window_levels(kDelta, std::max(1, static_cast<int>(d.rows.size())), d.n);
    test::play(rng, d);
    const Window w = d.window();
    const WindowAssumption a{d.s, d.levels, d.moving, {}, {}};
    const auto judge = [&](const char* name, const WindowWitness& found) {
      if (std::isinf(found.region.radius)) return;
      bool failed = found.region.refuted();
      for (const Proof& proof : found.proofs) {
        bool lies = false;
        for (int t = 0; t < d.steps; ++t)
          lies = lies || ((proof.step == kAlways || proof.step == t) &&
                          test::contains(d.attacked[static_cast<std::size_t>(t)], proof.source));
        failed = failed || !lies;
      }
      if (!failed) {
        const Vector error = (d.x.back() - found.region.center).cwiseAbs();
        failed = (error.array() > found.region.box.array() + 1e-9 * (1.0 + d.x.back().norm())).any() ||
                 error.norm() > found.region.radius + 1e-9 * (1.0 + d.x.back().norm());
      }
      ++tally[name].first;
      tally[name].second += failed ? 1 : 0;
    };
    judge(d.moving ? "W2M, moving" : "W2M", leverage_window(w, a));
    if (d.moving) continue;
    judge("W3M", subsets_window(w, a));
    judge("A", anytime_window(w, a, 10));
  }
  for (const auto& [name, count] : tally) {
    std::cout << name << ", Gaussian noise, promise " << kDelta << ": " << count.second << " of "
              << count.first << " failed\n";
    CHECK(count.first > test::tried(1000));
    CHECK(count.second <= kDelta * count.first);
  }
  CHECK(tally.at("W3M").second > 0);  // noise does reach the levels
}

TEST_CASE("a region carried on step by step as a set prior holds, with other liars in every step") {
  test::Rng rng(kSeed + 5);
  int answers = 0;
  for (int k = 0; k < test::tried(1200); ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 3);
    const int m = test::whole(rng, 4, 7);
    const int s = test::whole(rng, 0, 1);
    Matrix A = Matrix::Identity(n, n) + 0.2 * test::normal_matrix(rng, n, n);
    A *= test::uniform(rng, 0.7, 1.05) / Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
    const Matrix Gam = 0.1 * test::normal_matrix(rng, n, n);
    const Matrix C = test::normal_matrix(rng, n, m);
    const WindowLevels z = window_levels(1e-8, m, n);
    Vector x = 3.0 * test::normal_matrix(rng, n, 1);
    Region region = ellipsoid(x + test::unit_vector(rng, n), Matrix::Identity(n, n), 1.0 + 1e-12);
    for (int t = 0; t < 20; ++t) {
      CAPTURE(t);
      Window w(n, n, 2, m, m);
      w.begin(2);
      w.prior_set(region.center, region.shape, region.stretch, 15.0);
      w.advance(A, Gam, Vector::Zero(n));
      x = A * x + Gam * test::normal_matrix(rng, n, 1);
      const std::vector<int> liars = test::choose(rng, s, m);
      const double size = std::pow(10.0, test::uniform(rng, -0.5, 2.0));
      for (int j = 0; j < m; ++j)
        w.add(j, {C.col(j).data(), static_cast<std::size_t>(n)},
              C.col(j).dot(x) + std::normal_distribution<>()(rng) + (test::contains(liars, j) ? size : 0.0),
              1.0);
      const WindowAssumption a{s, z, k % 2 == 0, {}, {}};
      const WindowWitness found = k % 2 == 0 ? leverage_window(w, a) : subsets_window(w, a);
      REQUIRE_FALSE(found.region.refuted());
      for (const Proof& proof : found.proofs) CHECK(test::contains(liars, proof.source));
      if (!found.region.answered()) break;
      ++answers;
      CHECK(((x - found.region.center).cwiseAbs().array() <= found.region.box.array()).all());
      CHECK((x - found.region.center).norm() <= found.region.radius);
      region = found.region;
    }
  }
  std::cout << "one-step recursion: " << answers << " answers\n";
  CHECK(answers > test::tried(15000));
}

TEST_CASE("states far from the origin are not taken for attacks by rounding") {
  test::Rng rng(kSeed + 2);
  int refuted = 0;
  int proved = 0;
  for (int k = 0; k < test::tried(2000); ++k) {
    CAPTURE(k);
    test::WindowCase d = test::draw_window(rng, false, k % 2 == 0);
    if (k % 2 == 0) d.levels = {0.0, 0.0, 0.0, kNaN};
    d.s = std::min(2, d.sources - 1);  // some sets know no more than they have to
    d.x0 *= std::pow(10.0, test::uniform(rng, 3.0, 9.0));
    d.c0 = d.x0;
    test::play(rng, d);
    const Window w = d.window();
    const WindowAssumption a{d.s, d.levels, false, {}, {}};
    for (const WindowWitness& found :
         {leverage_window(w, a), subsets_window(w, a), anytime_window(w, a, 30)}) {
      refuted += found.region.refuted() ? 1 : 0;
      for (const Proof& proof : found.proofs) {
        CHECK(test::contains(d.attacked.front(), proof.source));
        ++proved;
      }
      if (!found.region.answered()) continue;
      const Vector error = (d.x.back() - found.region.center).cwiseAbs();
      const double rounding = 1e-14 * d.x.back().norm();  // of the measurements themselves, and of the truth
      CHECK((error.array() <= found.region.box.array() * (1.0 + 1e-6) + rounding).all());
    }
  }
  CHECK(refuted == 0);
  CHECK(proved > test::tried(500));
}

TEST_CASE("a row of which hardly anything is left in the measurements is not taken for an attack") {
  // What process noise leaves in measurements is of the size of the square root of the rounding of 1.
  test::Rng rng(kSeed + 3);
  for (int k = 0; k < test::tried(1000); ++k) {
    CAPTURE(k);
    const int steps = test::whole(rng, 4, 12);
    const double decay = std::pow(10.0, test::uniform(rng, -2.5, -0.3));
    const Matrix A = Matrix::Constant(1, 1, decay);
    const Matrix Gam = Matrix::Constant(1, 1, std::pow(10.0, test::uniform(rng, -9.5, -7.0)));
    Window w(1, 1, steps, 3, steps * 3);
    w.begin(steps);
    double x = std::normal_distribution<>()(rng);
    for (int t = 0; t < steps; ++t) {
      for (int j = 0; j < 3; ++j) {
        const double c = 1.0;
        w.add(j, {&c, 1}, x + std::normal_distribution<>()(rng), 1.0);
      }
      if (t + 1 == steps) break;
      w.advance(A, Gam, Vector::Zero(1));
      x = decay * x + Gam(0, 0) * std::normal_distribution<>()(rng);
    }
    const WindowAssumption a{1, window_levels(1e-9, steps * 3, 1), false, {}, {}};
    for (const WindowWitness& found : {subsets_window(w, a), anytime_window(w, a, 10)}) {
      CHECK_FALSE(found.region.refuted());
      CHECK(found.proofs.empty());
    }
  }
}

TEST_CASE("with bounded noise at its bounds the sets always hold, and the hull is the smallest of them") {
  test::Rng rng(kSeed + 1);
  Tally leverage;
  Tally subsets;
  int hulls = 0;
  for (int k = 0; k < test::tried(4400); ++k) {
    CAPTURE(k);
    test::WindowCase d = test::draw_window(rng, k % 4 == 0, true);
    d.levels = {0.0, 0.0, 0.0, kNaN};
    test::play(rng, d);
    const Window w = d.window();
    const WindowAssumption a{d.s, d.levels, d.moving, {}, {}};
    check(d, leverage_window(w, a), leverage);
    if (d.moving) continue;
    const WindowWitness by_subsets = subsets_window(w, a);
    check(d, by_subsets, subsets);
    if (k % 3 != 0) continue;
    const Box hull = hull_window(w, d.s);
    if (!std::isfinite(hull.lo(0))) continue;
    ++hulls;
    const Vector slack = Vector::Constant(d.n, 1e-7 * (1.0 + d.x.back().norm()));
    CHECK((hull.lo.array() <= (d.x.back() + slack).array()).all());
    CHECK((hull.hi.array() >= (d.x.back() - slack).array()).all());
    if (!by_subsets.region.answered()) continue;
    CHECK((hull.hi.array() <= (by_subsets.region.center + by_subsets.region.box + slack).array()).all());
    CHECK((hull.lo.array() >= (by_subsets.region.center - by_subsets.region.box - slack).array()).all());
  }
  print("W2M, bounded", leverage);
  print("W3M, bounded", subsets);
  std::cout << "hulls: " << hulls << "\n";
  CHECK(leverage.answered > test::tried(3000));
  CHECK(subsets.answered > test::tried(3000));
  CHECK(hulls > test::tried(1000));
}

TEST_CASE("more than s liars are refuted, and a window without enough rows says so") {
  Window w(1, 1, 3, 4, 12);
  const Matrix one = Matrix::Ones(1, 1);
  const auto fill = [&](double lie) {
    w.begin(3);
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 4; ++j) {
        const double c = 1.0;
        w.add(j, {&c, 1}, j < 2 ? lie * (j == 0 ? 1.0 : -1.0) : 0.0, 0.01);
      }
      if (k < 2) w.advance(one, 0.01 * one, Vector::Zero(1));
    }
  };
  fill(50.0);
  const WindowLevels z = window_levels(1e-6, 12, 1);
  CHECK(leverage_window(w, {1, z, false, {}, {}}).region.refuted());
  CHECK(subsets_window(w, {1, z, false, {}, {}}).region.refuted());
  CHECK(anytime_window(w, {1, z, false, {}, {}}, 10).region.refuted());
  const WindowWitness two = subsets_window(w, {2, z, false, {}, {}});
  CHECK(two.region.answered());
  CHECK(two.proofs.size() == 2);
  for (const int s : {4, 9}) {
    const WindowWitness none = leverage_window(w, {s, z, false, {}, {}});
    CHECK_FALSE(none.region.answered());
    CHECK_FALSE(none.region.refuted());
    CHECK_FALSE(subsets_window(w, {s, z, false, {}, {}}).region.answered());
  }
}

TEST_CASE("bad input to the windows is refused") {
  CHECK_THROWS_AS(Window(0, 1, 1, 1, 1), InvalidInput);
  CHECK_THROWS_AS(Window(100000, 1, 1000, 1, 1), InvalidInput);
  Window w(2, 1, 3, 4, 8);
  CHECK_THROWS_AS(w.begin(4), InvalidInput);
  CHECK_THROWS_AS(w.begin(2, 0.0), InvalidInput);
  w.begin(2);
  CHECK_THROWS_AS(w.prior_gaussian(Vector::Zero(2), Matrix::Zero(2, 2)), InvalidInput);
  CHECK_THROWS_AS(w.prior_set(Vector::Zero(2), Matrix::Identity(2, 2), -1.0), InvalidInput);
  CHECK_THROWS_AS(w.prior_gaussian(Vector::Zero(3), Matrix::Identity(3, 3)), InvalidInput);
  const std::vector<double> c{1.0, 0.0};
  CHECK_FALSE(w.add(4, c, 1.0, 1.0));
  CHECK_FALSE(w.add(0, c, kNaN, 1.0));
  CHECK_FALSE(w.add(0, c, 1.0, 0.0));
  CHECK_FALSE(w.add(0, std::vector<double>{0.0, 0.0}, 1.0, 1.0));
  CHECK(w.add(0, c, 1.0, 1.0));
  CHECK_THROWS_AS(w.prior_gaussian(Vector::Zero(2), Matrix::Identity(2, 2)), InvalidInput);
  CHECK_THROWS_AS(w.advance(Matrix::Identity(3, 3), Matrix::Ones(2, 1), Vector::Zero(2)), InvalidInput);
  const WindowLevels z{3.0, 3.0, 3.0, kNaN};
  CHECK_THROWS_AS(leverage_window(w, {0, z, false, {}, {}}), InvalidInput);  // its last step is not reached
  w.advance(Matrix::Identity(2, 2), Matrix::Ones(2, 1), Vector::Zero(2));
  CHECK_THROWS_AS(w.advance(Matrix::Identity(2, 2), Matrix::Ones(2, 1), Vector::Zero(2)), InvalidInput);
  CHECK_THROWS_AS(leverage_window(w, {-1, z, false, {}, {}}), InvalidInput);
  CHECK_THROWS_AS(leverage_window(w, {0, {}, false, {}, {}}), InvalidInput);
  const std::vector<int> twice{1, 1};
  const std::vector<int> far{9};
  const std::vector<int> one{1};
  CHECK_THROWS_AS(leverage_window(w, {2, z, false, twice, {}}), InvalidInput);
  CHECK_THROWS_AS(leverage_window(w, {2, z, false, far, {}}), InvalidInput);
  CHECK_THROWS_AS(leverage_window(w, {2, z, false, one, one}), InvalidInput);
  CHECK_THROWS_AS(leverage_window(w, {2, z, true, one, {}}), InvalidInput);
  CHECK_THROWS_AS(subsets_window(w, {2, z, true, {}, {}}), InvalidInput);
  CHECK_THROWS_AS(anytime_window(w, {2, z, false, {}, {}}, 0), InvalidInput);
  CHECK_THROWS_AS(hull_window(w, 1), InvalidInput);  // Gaussian rows
  CHECK_THROWS_AS(window_levels(0.0, 3, 1), InvalidInput);
}
