// SPDX-License-Identifier: Apache-2.0
// Banks of filters: runs with attacks that hide, losses, inputs and rows that change; the width for ever; the
// double integrator of docs/certificates.md.
#include "garrison/certificate/memory/bank.hpp"

#include <doctest/doctest.h>

#include <iostream>

#include "../random_network.hpp"
#include "aligned_noise.hpp"
#include "garrison/certificate/leverage_ball.hpp"
#include "garrison/certificate/memory/leverage_window.hpp"
#include "garrison/certificate/propagate.hpp"
#include "garrison/wire/archive.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

constexpr std::uint64_t kSeed = 20261130;

double normal(test::Rng& rng) { return std::normal_distribution<>()(rng); }

Vector noise(test::Rng& rng, const Matrix& root) {
  return root * test::normal_matrix(rng, static_cast<int>(root.cols()), 1);
}

struct BankCase {
  Matrix A, root;  // Q = root root'
  std::vector<BankSource> sources;
  int s, n, outputs = 0;
  std::vector<int> attacked;
  Matrix Q() const { return root * root.transpose(); }
};

BankCase draw(test::Rng& rng) {
  BankCase d;
  d.n = test::whole(rng, 1, 3);
  d.A = Matrix::Identity(d.n, d.n) + 0.2 * test::normal_matrix(rng, d.n, d.n);
  d.A *= test::uniform(rng, 0.7, 1.1) / Eigen::JacobiSVD<Matrix>(d.A).singularValues()(0);
  d.root = 0.2 * test::normal_matrix(rng, d.n, d.n);
  const int m = test::whole(rng, 3, 6);
  for (int j = 0; j < m; ++j) {
    const int outputs = test::whole(rng, 1, 2);
    Vector R(outputs);
    for (double& r : R) r = std::pow(10.0, test::uniform(rng, -1.0, 1.0));
    d.sources.push_back({test::normal_matrix(rng, outputs, d.n), R});
    d.outputs += outputs;
  }
  d.s = test::whole(rng, 0, std::min(2, m / 2));
  d.attacked = test::choose(rng, test::whole(rng, 0, d.s), m);
  return d;
}

/// `count` sources with one output each, of variance 1.
std::vector<BankSource> alike(std::size_t count, const Matrix& C) {
  std::vector<BankSource> sources(count);
  for (BankSource& source : sources) {
    source.C = C;
    source.R = Vector::Ones(1);
  }
  return sources;
}

/// What everybody says: attackers show another state.
Vector say(test::Rng& rng, const BankCase& d, const std::vector<BankSource>& sources, const Vector& x,
           const Vector& other, int kind) {
  Vector y(d.outputs);
  Eigen::Index at = 0;
  for (std::size_t j = 0; j < sources.size(); ++j)
    for (Eigen::Index i = 0; i < sources[j].R.size(); ++i, ++at) {
      const bool lies = test::contains(d.attacked, static_cast<int>(j));
      y(at) =
          sources[j].C.row(i).dot(lies && kind != 1 ? other : x) + std::sqrt(sources[j].R(i)) * normal(rng);
      if (lies && kind == 1) y(at) += 30.0;
      if (test::whole(rng, 0, 9) == 0) y(at) = kNaN;
    }
  return y;
}

struct Stacked {
  Matrix C;
  Vector R;
  std::vector<int> source;
};
Stacked stacked(const BankCase& d) {
  Stacked all{Matrix(d.outputs, d.n), Vector(d.outputs), {}};
  Eigen::Index at = 0;
  for (std::size_t j = 0; j < d.sources.size(); ++j)
    for (Eigen::Index i = 0; i < d.sources[j].R.size(); ++i, ++at) {
      all.C.row(at) = d.sources[j].C.row(i);
      all.R(at) = d.sources[j].R(i);
      all.source.push_back(static_cast<int>(j));
    }
  return all;
}

}  // namespace

TEST_CASE(
    "a bank that knows nothing at its start is least squares over all rows, at the edge of its promise") {
  test::Rng rng(kSeed + 7);
  const WindowLevels z{6.0, 6.0, 6.0, kNaN};
  constexpr int kSteps = 16;
  int answers = 0;
  int late = 0;
  int proved = 0;
  double largest = 0.0;
  for (int k = 0; k < test::tried(1000); ++k) {
    CAPTURE(k);
    const BankCase d = draw(rng);
    const Stacked all = stacked(d);
    const auto lies = [&](int r) {
      return test::contains(d.attacked, all.source[static_cast<std::size_t>(r)]);
    };
    // Who hears what is decided before any noise is.
    Matrix here(kSteps, d.outputs);
    for (Eigen::Index t = 0; t < kSteps; ++t)
      for (Eigen::Index r = 0; r < d.outputs; ++r) here(t, r) = test::whole(rng, 0, 9) > (t < 3 ? 5 : 0);
    const auto noise =
        test::aligned_noise(d.A, d.root, all.C, all.R, kSteps, test::unit_vector(rng, d.n),
                            6.0 * (1.0 - 1e-9), [&](int t, int r) { return here(t, r) != 0.0 && !lies(r); });
    Bank bank(d.A, d.Q(), d.sources, d.s);
    bank.start_unknown();
    Vector x = std::pow(10.0, test::uniform(rng, 0.0, 6.0)) * test::normal_matrix(rng, d.n, 1);
    Vector other = x + std::pow(10.0, test::uniform(rng, -0.5, 2.5)) * test::unit_vector(rng, d.n);
    bool answered = false;
    for (int t = 0; t < kSteps; ++t) {
      CAPTURE(t);
      if (t > 0) {
        const Vector step = d.root * noise.w.row(t - 1).transpose();
        x = d.A * x + step;
        other = d.A * other + step;
      }
      Vector y = all.C * x + all.R.cwiseSqrt().cwiseProduct(noise.v.row(t).transpose());
      for (int r = 0; r < d.outputs; ++r) {
        if (lies(r)) y(r) = k % 3 == 0 ? y(r) + 30.0 : all.C.row(r).dot(other);
        if (here(t, r) == 0.0) y(r) = kNaN;
      }
      BankStep step;
      step.predict = t > 0;
      const WindowWitness& found = bank.update(y, z, step);
      REQUIRE_FALSE(found.region.refuted());
      for (const Proof& proof : found.proofs) {
        CHECK(test::contains(d.attacked, proof.source));
        ++proved;
      }
      late += found.region.answered() || t == 0 ? 0 : 1;
      if (!found.region.answered()) continue;
      answered = true;
      ++answers;
      const Vector error = (x - found.region.center).cwiseAbs();
      const double rounding = 1e-12 * x.norm();
      CHECK((error.array() <= found.region.box.array() * (1.0 + 1e-9) + rounding).all());
      CHECK(error.norm() <= found.region.radius * (1.0 + 1e-9) + rounding);
      if (t == kSteps - 1) largest = std::max(largest, error.norm() / found.region.radius);
    }
    if (static_cast<int>(d.sources.size()) > 2 * d.s) CHECK(answered);
  }
  std::cout << "bank from nothing: " << answers << " answers, " << late << " samples without, " << proved
            << " proofs, largest error/radius " << largest << "\n";
  CHECK(answers > test::tried(10000));
  CHECK(late > test::tried(200));
  CHECK(proved > test::tried(1000));
  CHECK(largest > 0.99);
}

TEST_CASE("a bank that knows nothing waits for rows, forgets, and goes on from what it wrote down") {
  const Matrix A = (Matrix(2, 2) << 1.0, 1e-9, 0.0, 1.0).finished();  // metres, and metres per gigasecond
  const Matrix position = (Matrix(1, 2) << 1.0, 0.0).finished();
  const Matrix Q = Matrix::Zero(2, 2);
  const WindowLevels z{6.0, 6.0, 6.0, kNaN};
  Bank bank(A, Q, alike(3, position), 1);
  bank.start_unknown();
  CHECK(std::isinf(bank.update(Vector::Zero(3), z).region.radius));
  Bank other(A, Q, alike(3, position), 1);
  other.start_unknown();
  Vector y = Vector::Zero(3);
  y(2) = 100.0;  // lies from now on
  CHECK(
      bank.update(y, z).region.answered());  // two positions each: of two members they contradict each other
  CHECK(bank.members().size() == 1);
  CHECK(bank.members().front().left_out == std::vector<int>{2});
  REQUIRE(wire::from_bytes(wire::to_bytes(bank), 1, other) == Refusal::none);
  REQUIRE(other.resume());
  CHECK(other.members().front().left_out == std::vector<int>{2});
  for (int t = 0; t < 3; ++t) {
    const Region one = bank.update(y, z).region;
    const Region two = other.update(y, z).region;
    CHECK(one.center == two.center);
    CHECK(one.radius == two.radius);
    CHECK(one.box == two.box);
  }
  bank.forget();
  CHECK(bank.members().size() == 3);
  CHECK(bank.members().front().left_out == std::vector<int>{0});
  CHECK(std::isinf(bank.update(Vector::Constant(3, kNaN), z).region.radius));
}

TEST_CASE(
    "a bank contains the truth through attacks, losses, inputs and changing rows, and accuses nobody "
    "honest") {
  test::Rng rng(kSeed);
  const WindowLevels z{two_sided(1e-9), 7.0, two_sided(1e-9), kNaN};
  int steps = 0;
  int proved = 0;
  int merged = 0;
  double largest = 0.0;
  for (int k = 0; k < test::tried(1000); ++k) {
    CAPTURE(k);
    BankCase d = draw(rng);
    Bank bank(d.A, d.Q(), d.sources, d.s);
    const Matrix root0 = Matrix::Identity(d.n, d.n) + 0.3 * test::normal_matrix(rng, d.n, d.n);
    const Matrix P0 = root0 * root0.transpose();
    Vector x = 5.0 * test::normal_matrix(rng, d.n, 1);
    const bool set = k % 2 == 0;
    if (set)
      bank.restart(ellipsoid(x + 2.0 * root0 * test::unit_vector(rng, d.n), P0, 2.0 * (1.0 + 1e-12)));
    else
      bank.start_gaussian(x + noise(rng, root0), P0);
    Vector other = x + std::pow(10.0, test::uniform(rng, -0.5, 1.5)) * test::unit_vector(rng, d.n);
    for (int t = 0; t < 40; ++t) {
      CAPTURE(t);
      Matrix A = d.A;
      if (t % 5 == 0) A += 0.05 * test::normal_matrix(rng, d.n, d.n);
      const Vector u = test::normal_matrix(rng, d.n, 1);
      const Vector w = noise(rng, d.root);
      x = A * x + u + w;
      other = A * other + u + w;
      std::vector<BankSource> sources = d.sources;
      if (t % 7 == 0)
        for (auto& source : sources)
          source.C += 0.1 * test::normal_matrix(rng, static_cast<int>(source.C.rows()), d.n);
      const int kind = k % 3 == 0 ? 1 : 0;
      const BankStep step{&A, &u, nullptr, &sources, true};
      const WindowWitness& found = bank.checked_update(say(rng, d, sources, x, other, kind), z, step);
      CHECK_FALSE(found.region.refuted());
      REQUIRE(found.region.answered());
      const Vector error = x - found.region.center;
      CHECK((error.cwiseAbs().array() <= found.region.box.array()).all());
      CHECK(error.norm() <= found.region.radius);
      CHECK(error.dot(Eigen::LDLT<Matrix>(found.region.shape).solve(error)) <=
            found.region.stretch * found.region.stretch * (1.0 + 1e-9));
      largest = std::max(largest, error.cwiseAbs().cwiseQuotient(found.region.box).maxCoeff());
      for (const Proof& proof : found.proofs) {
        CHECK(test::contains(d.attacked, proof.source));
        ++proved;
      }
      ++steps;
      if (t == 20 && k % 4 == 1) {
        const Region now = found.region;
        bank.restart(now);
      }
      if (t == 25 && k % 5 == 1 && bank.members().size() > 2) {
        bank.merge(2, z);
        CHECK(bank.members().size() == 2);
        ++merged;
      }
    }
  }
  std::cout << "bank: " << steps << " steps, " << proved << " proofs, " << merged
            << " merged, largest error/box " << largest << "\n";
  CHECK(proved > test::tried(5000));
  CHECK(merged > test::tried(60));
  CHECK(largest > 0.3);
}

TEST_CASE("a bank refutes more than s liars, and needs a start") {
  const Matrix one = Matrix::Ones(1, 1);
  const std::vector<BankSource> four = alike(4, one);
  const WindowLevels z{5.0, 5.5, 5.2, kNaN};
  Bank bank(one, 0.01 * one, four, 1);
  CHECK(std::isinf(bank.checked_update(Vector::Zero(4), z).region.radius));
  bank.start_gaussian(Vector::Zero(1), one);
  Vector y(4);
  y << 50.0, -50.0, 0.0, 0.0;
  CHECK(bank.checked_update(y, z).region.refuted());
  CHECK(bank.checked_update(Vector::Zero(4), z).region.refuted());  // the dead do not come back
  bank.start_gaussian(Vector::Zero(1), one);
  CHECK(bank.checked_update(Vector::Zero(4), z).region.answered());
}

TEST_CASE("the width for ever holds for every living member, whatever hides among the sources") {
  test::Rng rng(kSeed + 1);
  const WindowLevels z{6.0, two_sided(1e-8) + 1.0, two_sided(1e-8), kNaN};
  int finite = 0;
  int comparisons = 0;
  double largest = 0.0;
  double largest_box = 0.0;
  for (int k = 0; k < test::tried(1200); ++k) {
    CAPTURE(k);
    BankCase d = draw(rng);
    d.root += 0.05 * Matrix::Identity(d.n, d.n);
    const Vector width = bank_steady(d.A, d.Q(), d.sources, d.s, z);
    const Vector half = bank_steady_width(d.A, d.Q(), d.sources, d.s, z);
    CHECK(half.allFinite() == width.allFinite());
    if (!width.allFinite()) continue;
    CHECK((half.array() > width.head(d.n).array()).all());
    ++finite;
    Bank bank(d.A, d.Q(), d.sources, d.s);
    Vector x = Vector::Zero(d.n);
    bank.start_gaussian(x, Matrix::Identity(d.n, d.n));
    const double push = test::uniform(rng, 0.5, 4.0);
    for (int t = 0; t < 200; ++t) {
      x = d.A * x + noise(rng, d.root);
      Vector y(d.outputs);
      // The attackers pull a member that still lives as far as it stands.
      const auto living = bank.members();
      REQUIRE(!living.empty());
      const Vector predicted = d.A * living.back().c;
      Eigen::Index at = 0;
      for (std::size_t j = 0; j < d.sources.size(); ++j)
        for (Eigen::Index i = 0; i < d.sources[j].R.size(); ++i, ++at) {
          const double sigma = std::sqrt(d.sources[j].R(i));
          const bool lies = test::contains(d.attacked, static_cast<int>(j));
          y(at) = d.sources[j].C.row(i).dot(lies ? predicted : x) + sigma * (lies ? push : normal(rng));
        }
      const Region region = bank.update(y, z).region;
      CHECK_FALSE(region.refuted());
      if (t < 150) continue;
      CHECK((region.box.array() <= half.array()).all());
      largest_box = std::max(largest_box, region.box.cwiseQuotient(half).maxCoeff());
      for (const BankMember& member : bank.members()) {
        const Vector error = (member.c - x).cwiseAbs();
        CHECK((error.array() <= width.head(d.n).array()).all());
        CHECK(error.norm() <= width(d.n));
        largest = std::max(largest, error.cwiseQuotient(width.head(d.n)).maxCoeff());
        ++comparisons;
      }
    }
  }
  std::cout << "width for ever: " << finite << " systems, " << comparisons
            << " comparisons, largest error/width " << largest << ", box/width " << largest_box << "\n";
  CHECK(finite > test::tried(1000));
  CHECK(comparisons > test::tried(100000));
  CHECK(largest > 0.1);
}

TEST_CASE(
    "six position sensors of a double integrator, two of them lying: one step says nothing, the bank does") {
  test::Rng rng(kSeed + 2);
  const double dt = 0.1;
  Matrix A(2, 2);
  A << 1.0, dt, 0.0, 1.0;
  Vector Gam(2);
  Gam << 0.5 * dt * dt, dt;
  Gam *= 0.5;  // acceleration of deviation 0.5
  Matrix position(1, 2);
  position << 1.0, 0.0;
  const std::vector<BankSource> sources = alike(6, position);
  const double delta = 1e-6;
  const WindowLevels z = window_levels(delta, 6, 2);

  // One sample: no velocity in it.
  const Matrix C = position.replicate(6, 1);
  Assumption one_sample{2, gaussian_levels(delta, 6, 2), false, nullptr, {}};
  CHECK(
      std::isinf(leverage_ball(given_rows(Vector::Zero(6), C, Vector::Ones(6), Vector(), {}).rows, one_sample)
                     .region.radius));

  const Vector steady = bank_steady(A, Gam * Gam.transpose() + 1e-9 * Matrix::Identity(2, 2), sources, 2, z);
  CHECK(steady.allFinite());
  CHECK(std::isinf(bank_steady(A, Gam * Gam.transpose() + 1e-9 * Matrix::Identity(2, 2), sources, 3, z)(0)));
  for (const bool loud : {false, true}) {
    CAPTURE(loud);
    Bank bank(A, Gam * Gam.transpose(), sources, 2);
    Vector x(2);
    x << 0.0, 1.0;
    bank.start_gaussian(x, Matrix::Identity(2, 2));
    Vector box = Vector::Zero(2);
    int outside = 0;
    std::size_t proofs = 0;
    for (int t = 1; t <= 300; ++t) {
      x = A * x + Gam * normal(rng);
      Vector y(6);
      for (double& value : y) value = x(0) + normal(rng);
      y(1) += loud ? 60.0 : 2.0;
      y(4) += loud ? 60.0 : 2.0;
      const WindowWitness& found = bank.update(y, z);
      REQUIRE(found.region.answered());
      outside += ((x - found.region.center).cwiseAbs().array() > found.region.box.array()).any() ? 1 : 0;
      proofs = found.proofs.size();
      if (t > 200) box += found.region.box / 100.0;
    }
    std::cout << "double integrator, 6 positions, " << (loud ? "loud" : "offset of 2") << ": box "
              << box.transpose() << ", proved " << proofs << ", for ever " << steady.transpose() << "\n";
    CHECK(outside == 0);
    if (loud) {
      CHECK(proofs == 2);
      CHECK(box(0) == doctest::Approx(0.95).epsilon(0.15));
    }
  }
}

TEST_CASE("bad input to the bank is refused") {
  const Matrix one = Matrix::Ones(1, 1);
  const std::vector<BankSource> two = alike(2, one);
  std::vector<BankSource> useless = alike(1, one);
  useless.front().R.setZero();
  CHECK_THROWS_AS(Bank(one, -one, two, 1), InvalidInput);
  CHECK_THROWS_AS(Bank(one, one, {}, 0), InvalidInput);
  CHECK_THROWS_AS(Bank(one, one, two, 3), InvalidInput);
  CHECK_THROWS_AS(Bank(one, one, two, 1, 1), InvalidInput);
  CHECK_THROWS_AS(Bank(one, one, useless, 0), InvalidInput);
  Bank bank(one, one, two, 1);
  CHECK_THROWS_AS(bank.start_gaussian(Vector::Zero(2), one), InvalidInput);
  CHECK_THROWS_AS(bank.restart(Region{}), InvalidInput);
  CHECK_THROWS_AS(bank.checked_update(Vector::Zero(3), {1, 1, 1, kNaN}), InvalidInput);
  CHECK_THROWS_AS(bank.checked_update(Vector::Zero(2), {}), InvalidInput);
  CHECK_THROWS_AS(bank.merge(0, {1, 1, 1, kNaN}), InvalidInput);
  CHECK_THROWS_AS(bank_steady(one, one, two, -1, {1, 1, 1, kNaN}), InvalidInput);
}
