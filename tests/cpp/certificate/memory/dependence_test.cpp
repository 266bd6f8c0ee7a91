// SPDX-License-Identifier: Apache-2.0
// What banks say against white noise: rarely where it is white, whatever is lost and whoever lies; soon where
// it is not.
#include <doctest/doctest.h>

#include <iostream>

#include "../random_network.hpp"
#include "garrison/certificate/memory/bank.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

constexpr std::uint64_t kSeed = 20261202;
constexpr WindowLevels kLevels{6.0, 6.0, 6.0, kNaN};

double normal(test::Rng& rng) { return std::normal_distribution<>()(rng); }

/// Noise with this correlation of neighbours, of variance 1.
class Coloured {
 public:
  explicit Coloured(double correlation) : correlation_(correlation) {}
  double next(test::Rng& rng) {
    const double fresh = normal(rng);
    last_ = begun_ ? correlation_ * last_ + std::sqrt(1.0 - correlation_ * correlation_) * fresh : fresh;
    begun_ = true;
    return last_;
  }

 private:
  double correlation_, last_ = 0.0;
  bool begun_ = false;
};

struct Plant {
  Matrix A, root;  // Q = root root'
  std::vector<BankSource> sources;
  int outputs = 0;
  Matrix C() const {
    Matrix all(outputs, A.rows());
    Eigen::Index at = 0;
    for (const BankSource& source : sources) {
      all.middleRows(at, source.C.rows()) = source.C;
      at += source.C.rows();
    }
    return all;
  }
  Vector deviations() const {
    Vector all(outputs);
    Eigen::Index at = 0;
    for (const BankSource& source : sources) {
      all.segment(at, source.R.size()) = source.R.cwiseSqrt();
      at += source.R.size();
    }
    return all;
  }
};

/// growth: the largest singular value of A, at most.
Plant draw(test::Rng& rng, int sources, double process, double growth) {
  Plant p;
  const int n = test::whole(rng, 1, 3);
  p.A = Matrix::Identity(n, n) + 0.2 * test::normal_matrix(rng, n, n);
  p.A *= test::uniform(rng, 0.7, growth) / Eigen::JacobiSVD<Matrix>(p.A).singularValues()(0);
  p.root = process * test::normal_matrix(rng, n, n);
  for (int j = 0; j < sources; ++j) {
    const int outputs = test::whole(rng, 1, 2);
    Vector R(outputs);
    for (double& r : R) r = std::pow(10.0, test::uniform(rng, -1.0, 1.0));
    p.sources.push_back({test::normal_matrix(rng, outputs, n), R});
    p.outputs += outputs;
  }
  return p;
}

}  // namespace

TEST_CASE(
    "white noise is said to remember its past as rarely as promised, whatever is lost and whoever lies") {
  test::Rng rng(kSeed);
  constexpr int kSystems = 600;
  constexpr int kSteps = 80;
  int said_at_5_percent = 0;
  double largest = -kInfinity;
  for (int k = 0; k < kSystems; ++k) {
    const int m = test::whole(rng, 3, 5);
    const int s = test::whole(rng, 0, 1);
    const Plant p = draw(rng, m, 0.2, 1.1);
    const int liar = s == 0 ? -1 : test::whole(rng, 0, m - 1);
    const int way = test::whole(rng, 0, 3);
    Bank bank(p.A, p.root * p.root.transpose(), p.sources, s);
    bank.start_unknown();
    const auto n = static_cast<int>(p.A.rows());
    const Matrix C = p.C();
    const Vector deviation = p.deviations();
    Vector x = 10.0 * test::normal_matrix(rng, n, 1);
    Coloured slow(0.95);
    double walk = 0.0;
    double most = -kInfinity;
    for (int t = 0; t < kSteps; ++t) {
      x = p.A * x + p.root * test::normal_matrix(rng, n, 1);
      walk += 0.1 * normal(rng);
      const double lie = way == 0   ? slow.next(rng)
                         : way == 1 ? walk
                         : way == 2 ? std::sin(0.2 * t)
                                    : 0.02 * t;
      Vector y = C * x;
      Eigen::Index at = 0;
      for (int j = 0; j < m; ++j)
        for (Eigen::Index i = 0; i < p.sources[static_cast<std::size_t>(j)].R.size(); ++i, ++at) {
          y(at) += deviation(at) * (j == liar ? 3.0 * lie : normal(rng));
          if (test::whole(rng, 0, 6) == 0) y(at) = kNaN;
        }
      if (test::whole(rng, 0, 30) == 0) y.setConstant(kNaN);
      bank.update(y, kLevels);
      most = std::max(most, bank.dependence().evidence);
      if (test::whole(rng, 0, 60) == 0) bank.forget();
    }
    said_at_5_percent += most > std::log(20.0) ? 1 : 0;
    largest = std::max(largest, most);
  }
  std::cout << "dependence of white noise: at 5 % said of " << said_at_5_percent << " of " << kSystems
            << " runs, largest evidence " << largest << "\n";
  CHECK(said_at_5_percent <= 0.05 * kSystems);
  CHECK(largest < std::log(1000.0));
  CHECK(largest > 0.0);  // it is not silent
}

TEST_CASE("noise with a correlation of one half is found within 300 samples") {
  test::Rng rng(kSeed + 1);
  constexpr int kSystems = 60;
  double least = kInfinity;
  for (int k = 0; k < kSystems; ++k) {
    CAPTURE(k);
    const int m = test::whole(rng, 3, 5);
    const int s = test::whole(rng, 0, 1);
    const Plant p = draw(rng, m, 0.01, 1.0);
    Bank bank(p.A, p.root * p.root.transpose(), p.sources, s);
    bank.start_unknown();
    const Matrix C = p.C();
    const Vector deviation = p.deviations();
    const auto n = static_cast<int>(p.A.rows());
    Vector x = test::normal_matrix(rng, n, 1);
    std::vector<Coloured> noise(static_cast<std::size_t>(p.outputs), Coloured(0.5));
    for (int t = 0; t < 300; ++t) {
      x = p.A * x + p.root * test::normal_matrix(rng, n, 1);
      Vector y = C * x;
      for (Eigen::Index r = 0; r < y.size(); ++r)
        y(r) += deviation(r) * noise[static_cast<std::size_t>(r)].next(rng);
      bank.update(y, kLevels);
    }
    const Dependence found = bank.dependence();
    CHECK(found.correlation > 0.3);
    CHECK(found.correlation < 0.7);
    CHECK(found.source >= 0);
    least = std::min(least, found.evidence);
  }
  std::cout << "dependence, correlation .5, 300 samples: least evidence " << least << "\n";
  CHECK(least > std::log(1e3 * 100.0));  // of a run of a hundred agents
}

TEST_CASE("one source whose noise remembers its past may be the liar: nothing is said then") {
  test::Rng rng(kSeed + 2);
  const Matrix one = Matrix::Identity(1, 1);
  const std::vector<BankSource> sources(4, {one, Vector::Ones(1)});
  for (const int s : {0, 1}) {
    Bank bank(one, 1e-4 * one, sources, s);
    bank.start_gaussian(Vector::Zero(1), one);
    Coloured noise(0.6);
    double x = 0.0;
    for (int t = 0; t < 400; ++t) {
      x += 0.01 * normal(rng);
      Vector y(4);
      for (double& value : y) value = x + normal(rng);
      y(2) = x + noise.next(rng);
      bank.update(y, kLevels);
    }
    const Dependence found = bank.dependence();
    if (s == 0) {
      CHECK(found.evidence > std::log(1e6));
      CHECK(found.source == 2);
      CHECK(found.correlation == doctest::Approx(0.6).epsilon(0.2));
      CHECK(found.pairs == 399.0);
      bank.start_gaussian(Vector::Zero(1), one);  // what was found stays, less the share of the new start
      CHECK(bank.dependence().evidence == found.evidence);
      bank.start_unknown();
      bank.forget(true);
      CHECK(bank.dependence().source == -1);
    } else {
      CHECK(found.evidence < std::log(20.0));
    }
  }
}

TEST_CASE("white noise that is only larger than modelled is not said to remember its past") {
  test::Rng rng(kSeed + 3);
  const Matrix one = Matrix::Identity(1, 1);
  int said = 0;
  for (int k = 0; k < 200; ++k) {
    Bank bank(0.0 * one, one, {{one, Vector::Ones(1)}}, 0);  // nothing of the past is in a sample
    bank.start_gaussian(Vector::Zero(1), one);
    for (int t = 0; t < 200; ++t)
      bank.update(Vector::Constant(1, 1.7 * std::sqrt(2.0) * normal(rng)), {20.0, 20.0, 20.0, kNaN});
    said += bank.dependence().evidence > std::log(20.0) ? 1 : 0;
  }
  CHECK(said <= 10);
}
