// SPDX-License-Identifier: Apache-2.0
// A search for a witness that does not contain the truth: random rows, noise at its bounds, attacks of every
// size.
#include <doctest/doctest.h>

#include <iostream>

#include "garrison/certificate/order_rule.hpp"
#include "garrison/certificate/scan.hpp"
#include "garrison/certificate/subsets.hpp"
#include "random_network.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

constexpr std::uint64_t kSeed = 20261128;

/// Sensors of a state; some sources have several rows.
struct Sample {
  Vector x, y, R, width;
  Matrix C;
  std::vector<int> source;
  std::vector<int> attacked;
  int sources;
  int s;

  GivenRows rows() const { return given_rows(y, C, R, width, source); }
};

Sample draw(test::Rng& rng, int n, int sources, int s, bool several) {
  Sample d;
  d.sources = sources;
  d.s = s;
  for (int k = 0; k < sources; ++k)
    for (int more = several ? test::whole(rng, 1, 3) : 1; more > 0; --more) d.source.push_back(k);
  const auto m = static_cast<Eigen::Index>(d.source.size());
  d.x = 10.0 * test::normal_matrix(rng, n, 1);
  d.C.resize(m, n);
  d.R.resize(m);
  d.width.resize(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    d.C.row(j) = test::unit_vector(rng, n).transpose() *
                 (test::whole(rng, 0, 3) == 0 ? test::uniform(rng, 0.3, 3.0) : 1.0);
    d.R(j) = std::pow(10.0, test::uniform(rng, -2.0, 0.0));
    d.width(j) = test::uniform(rng, 0.0, 2.0) * std::sqrt(d.R(j));
  }
  d.attacked = test::choose(rng, test::whole(rng, 0, s), sources);
  d.y = d.C * d.x;
  return d;
}

/// At most s sources say something else: a shift, another state's view, or values without sense.
void attack(test::Rng& rng, Sample& d) {
  const int kind = test::whole(rng, 0, 3);
  const double size = std::pow(10.0, test::uniform(rng, -1.0, 2.0));
  const Vector other = d.x + size * test::unit_vector(rng, static_cast<int>(d.x.size()));
  for (Eigen::Index j = 0; j < d.y.size(); ++j) {
    if (!test::contains(d.attacked, d.source[static_cast<std::size_t>(j)])) continue;
    if (kind == 0)
      d.y(j) += test::sign(rng) * size;
    else if (kind == 1)
      d.y(j) += d.C.row(j).dot(other - d.x);
    else if (kind == 2)
      d.y(j) = test::whole(rng, 0, 1) == 0 ? 1e140 : -1e9;
    else
      d.y(j) = kNaN;
  }
}

bool honest(const Sample& d, Eigen::Index j) {
  return !test::contains(d.attacked, d.source[static_cast<std::size_t>(j)]);
}

/// ||G^-1/2 xi|| over some rows.
template <class Uses>
double noise_length(const Sample& d, const Vector& v, const Uses& uses) {
  Matrix G = Matrix::Zero(d.x.size(), d.x.size());
  Vector xi = Vector::Zero(d.x.size());
  for (Eigen::Index j = 0; j < d.y.size(); ++j) {
    if (!uses(j)) continue;
    G += d.C.row(j).transpose() * d.C.row(j) / d.R(j);
    xi += d.C.row(j).transpose() * v(j) / d.R(j);
  }
  return std::sqrt(std::max(0.0, xi.dot(Eigen::LLT<Matrix>(G).solve(xi))));
}

void check_inside(const Witness& w, const Vector& x, double& largest) {
  CHECK_FALSE(w.region.refuted());
  if (!w.region.answered()) return;
  const double error = (x - w.region.center).norm();
  CHECK(error <= w.region.radius * (1.0 + 1e-9) + 1e-12);
  CHECK(((x - w.region.center).cwiseAbs().array() <= w.region.box.array() * (1.0 + 1e-9) + 1e-12).all());
  CHECK(bound_around(w.region, x) >= 0.0);
  if (w.region.radius > 0.0) largest = std::max(largest, error / w.region.radius);
}

}  // namespace

TEST_CASE(
    "W2 and the rules for one state contain the truth for noise at its bounds, and accuse nobody honest") {
  test::Rng rng(kSeed);
  int answered = 0;
  int proved = 0;
  double largest = 0.0;
  double widest = 0.0;
  for (int k = 0; k < 20000; ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 4);
    Sample d = draw(rng, n, test::whole(rng, 2, 12), test::whole(rng, 0, 4), k % 3 == 0);
    const Vector toward = test::unit_vector(rng, n);
    for (Eigen::Index j = 0; j < d.y.size(); ++j)  // at the bound, along one direction or anyhow
      d.y(j) += d.width(j) *
                (k % 2 == 0 ? (d.C.row(j).dot(toward) < 0.0 ? -1.0 : 1.0) : test::uniform(rng, -1.0, 1.0));
    attack(rng, d);
    const Region prior{d.x + 0.5 * test::unit_vector(rng, n), 0.5 * (1.0 + 1e-12), {}};
    Assumption a{d.s, {}, true, k % 5 == 0 ? &prior : nullptr, {}};
    const std::vector<int> known(d.attacked.begin(),
                                 d.attacked.begin() + (k % 7 == 0 && !d.attacked.empty() ? 1 : 0));
    a.proved = known;
    const Witness w = leverage_ball(d.rows().rows, a);
    check_inside(w, d.x, largest);
    answered += w.region.answered() ? 1 : 0;
    for (const int source : w.proved) {
      CHECK(test::contains(d.attacked, source));
      ++proved;
    }
    if (n != 1 || k % 3 == 0) continue;
    Vector sign(d.C.rows());
    for (Eigen::Index j = 0; j < sign.size(); ++j) sign(j) = d.C(j, 0) < 0.0 ? -1.0 : 1.0;
    const Vector length = d.C.col(0).cwiseAbs();
    const Vector y = sign.cwiseProduct(d.y).cwiseQuotient(length);
    const Vector half = d.width.cwiseQuotient(length);
    const Interval i = interval(y, half, d.s);
    CHECK(i.lo <= d.x(0));
    CHECK(i.hi >= d.x(0));
    const double xhat = d.x(0) + test::uniform(rng, -3.0, 3.0);
    const double bound = order_bound((y.array() - xhat).matrix(), half, d.s);
    CHECK(std::abs(xhat - d.x(0)) <= bound * (1.0 + 1e-12));
    // The interval rule is never worse.
    if (std::isfinite(bound)) {
      CHECK(std::max(i.hi - xhat, xhat - i.lo) <= bound * (1.0 + 1e-9) + 1e-9);
      widest = std::max(widest, std::abs(xhat - d.x(0)) / bound);
    }
  }
  CHECK(answered > 8000);
  CHECK(proved > 1000);
  std::cout << "W2 bounded: 20000 samples from seed " << kSeed << ", " << answered
            << " answered, largest error/bound " << largest << ", " << proved
            << " proved, none honest; order rule largest " << widest << '\n';
}

TEST_CASE("W2, W3 and W1 contain the truth whenever their events hold, at the edge of the events") {
  test::Rng rng(kSeed + 1);
  double w2 = 0.0;
  double w3 = 0.0;
  int answered = 0;
  int proved = 0;
  std::vector<double> ratio;
  for (int k = 0; k < test::tried(12000); ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 3);
    Sample d = draw(rng, n, test::whole(rng, n + 1, 10), test::whole(rng, 0, 3), k % 4 == 0);
    d.width.setZero();
    const Levels levels = gaussian_levels(0.05, static_cast<int>(d.y.size()), n);
    // K(H): the lowest and the highest `need` honest sources, and all honest.
    std::vector<int> good;
    for (int source = 0; source < d.sources; ++source)
      if (!test::contains(d.attacked, source)) good.push_back(source);
    const auto need = static_cast<std::size_t>(std::max(d.sources - d.s, 0));
    const auto lowest = [&](Eigen::Index j) {
      return test::contains(std::span(good).first(need), d.source[static_cast<std::size_t>(j)]);
    };
    const auto highest = [&](Eigen::Index j) {
      return test::contains(std::span(good).last(need), d.source[static_cast<std::size_t>(j)]);
    };
    Vector v = test::normal_matrix(rng, static_cast<int>(d.y.size()), 1).cwiseProduct(d.R.cwiseSqrt());
    if (k % 2 == 0) {  // along one direction
      const Vector toward = test::unit_vector(rng, n);
      for (Eigen::Index j = 0; j < v.size(); ++j)
        v(j) = std::abs(v(j)) * (d.C.row(j).dot(toward) < 0.0 ? -1.0 : 1.0);
    }
    double over = 0.0;
    for (Eigen::Index j = 0; j < v.size(); ++j)
      if (honest(d, j)) over = std::max(over, std::abs(v(j)) / (levels.z1 * std::sqrt(d.R(j))));
    for (const double length : {noise_length(d, v, [&](Eigen::Index j) { return honest(d, j); }),
                                noise_length(d, v, lowest), noise_length(d, v, highest)})
      if (std::isfinite(length)) over = std::max(over, length / levels.z2);
    if (over > 0.0)
      v *= test::whole(rng, 0, 1) == 0 ? 1.0 / over : std::min(1.0, 1.0 / over);  // the edge, or inside
    d.y += v;
    attack(rng, d);
    const Assumption a{d.s, levels, false, nullptr, {}};
    const Witness ball = leverage_ball(d.rows().rows, a);
    check_inside(ball, d.x, w2);
    for (const int source : ball.proved) CHECK(test::contains(d.attacked, source));
    // A source whose rows are all absent makes W3's sets smaller than the honest ones fixed above.
    if (d.y.array().isNaN().any()) continue;
    const Witness all = witness_subsets(d.rows().rows, a);
    check_inside(all, d.x, w3);
    if (d.sources >= 2 * d.s)
      for (const int source : all.proved) {
        CHECK(test::contains(d.attacked, source));
        ++proved;
      }
    if (ball.region.answered() && all.region.answered() && ball.region.radius > 0.0 && d.s > 0) {
      ++answered;
      ratio.push_back(all.region.radius / ball.region.radius);
    }
    if (n != 1 || k % 4 == 0) continue;
    const double xhat = d.x(0) + test::uniform(rng, -1.0, 1.0);
    const Vector length = d.C.col(0);
    const Vector r = (d.y.cwiseQuotient(length).array() - xhat).matrix();
    const Interval i = scan(r, d.R.cwiseQuotient(length.cwiseAbs2()), d.s, levels.z1, levels.z2);
    CHECK(i.lo <= d.x(0) - xhat + 1e-9);
    CHECK(i.hi >= d.x(0) - xhat - 1e-9);
  }
  std::sort(ratio.begin(), ratio.end());
  CHECK(answered > test::tried(1500));
  CHECK(proved > test::tried(300));
  CHECK(ratio[ratio.size() / 2] < 1.0);  // W3 is sharper, as a rule
  std::cout << "W2, W3, W1 at the edge of their events: " << test::tried(12000) << " samples from seed "
            << kSeed + 1 << ", largest error/bound " << w2 << ' ' << w3 << ", " << proved
            << " proved by W3, W3/W2 median " << ratio[ratio.size() / 2] << '\n';
}

TEST_CASE("a refutation needs more than s attacked, and comes when they are loud") {
  test::Rng rng(kSeed + 2);
  int refuted = 0;
  for (int k = 0; k < 2000; ++k) {
    const int n = test::whole(rng, 1, 2);
    Sample d = draw(rng, n, 9, 1, false);
    d.width.setZero();
    for (int j = 0; j < 3; ++j) d.y(3 * j) += test::sign(rng) * 1e3 * (j + 1);
    const Assumption a{1, gaussian_levels(1e-6, 9, n), false, nullptr, {}};
    const GivenRows given = d.rows();
    const Witness w2 = leverage_ball(given.rows, a);
    const Witness w3 = witness_subsets(given.rows, a);
    refuted += (w2.region.refuted() ? 1 : 0) + (w3.region.refuted() ? 1 : 0);
    if (w2.region.refuted()) CHECK(w2.proved.empty());
    CHECK_FALSE(w3.region.answered());
  }
  CHECK(refuted > 2500);
}

TEST_CASE(
    "a witness moves, turns and grows with its data, and does not care for order, signs and absent rows") {
  test::Rng rng(kSeed + 3);
  int done = 0;
  for (int k = 0; k < 1500; ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 4);
    Sample d = draw(rng, n, test::whole(rng, n + 2, 10), test::whole(rng, 0, 2), false);
    d.y += test::normal_matrix(rng, static_cast<int>(d.y.size()), 1).cwiseProduct(d.R.cwiseSqrt());
    d.width.setZero();
    d.attacked = test::choose(rng, d.s, d.sources);
    for (const int j : d.attacked) d.y(j) += test::uniform(rng, -20.0, 20.0);
    const Assumption a{d.s, gaussian_levels(1e-3, static_cast<int>(d.y.size()), n), false, nullptr, {}};
    const bool enumerate = k % 2 == 0;
    const auto ask = [&](const Sample& of) {
      const GivenRows given = of.rows();
      return enumerate ? witness_subsets(given.rows, a).region : leverage_ball(given.rows, a).region;
    };
    const Region was = ask(d);
    if (!was.answered()) continue;
    ++done;
    const double size = 1e-8 * (was.radius + d.x.norm());
    const auto same = [&](const Region& now, const Vector& center, double radius) {
      REQUIRE(now.answered());
      CHECK(now.radius == doctest::Approx(radius).epsilon(1e-8));
      if (!enumerate) CHECK((now.center - center).norm() <= size * (1.0 + radius / was.radius));
    };
    const Vector shift = 5.0 * test::normal_matrix(rng, n, 1);
    Sample moved = d;
    moved.y += d.C * shift;
    same(ask(moved), was.center + shift, was.radius);
    if (!enumerate) {  // the middle of the box, where W3 starts, turns with the axes
      const Matrix turn =
          Eigen::JacobiSVD<Matrix>(test::normal_matrix(rng, n, n), Eigen::ComputeFullU).matrixU();
      Sample turned = d;
      turned.C = d.C * turn.transpose();
      same(ask(turned), turn * was.center, was.radius);
    }
    Sample grown = d;
    grown.y *= 4.0;
    grown.R *= 16.0;
    same(ask(grown), 4.0 * was.center, 4.0 * was.radius);
    Sample other = d;  // reversed, every second row with the other sign, and one row absent
    const Eigen::Index m = d.y.size();
    other.C.resize(m + 1, n);
    other.y.resize(m + 1);
    other.R.resize(m + 1);
    other.width = Vector::Zero(m + 1);
    for (Eigen::Index j = 0; j < m; ++j) {
      const double flip = j % 2 == 0 ? 1.0 : -1.0;
      other.C.row(j) = flip * d.C.row(m - 1 - j);
      other.y(j) = flip * d.y(m - 1 - j);
      other.R(j) = d.R(m - 1 - j);
    }
    other.C.row(m).setOnes();
    other.y(m) = kNaN;
    other.R(m) = 1.0;
    other.source.push_back(static_cast<int>(m));
    same(ask(other), was.center, was.radius);
  }
  CHECK(done > 700);
}

TEST_CASE("more attackers give wider answers") {
  test::Rng rng(kSeed + 4);
  int compared = 0;
  for (int k = 0; k < 2000; ++k) {
    CAPTURE(k);
    Sample d = draw(rng, test::whole(rng, 1, 3), test::whole(rng, 4, 10), 0, false);
    d.y += test::normal_matrix(rng, static_cast<int>(d.y.size()), 1).cwiseProduct(d.R.cwiseSqrt());
    const GivenRows given = d.rows();
    const auto n = static_cast<int>(d.x.size());
    const auto m = static_cast<int>(d.y.size());
    Witness before;
    Interval was{kInfinity, -kInfinity};
    double order = 0.0;
    for (int s = 0; s <= m; ++s) {
      const Interval i = interval(d.y, d.width, s);
      const double o = order_bound(d.y, d.width, s);
      if (!std::isnan(was.lo) && was.lo <= was.hi) {
        CHECK(i.lo <= was.lo);
        CHECK(i.hi >= was.hi);
      }
      CHECK(o >= order);
      order = o;
      was = i;
      const Witness w = leverage_ball(given.rows, {s, gaussian_levels(1e-3, m, n), false, nullptr, {}});
      // Where neither drops anybody: then the rows, and with them the centre, are the same.
      if (s > 0 && w.kept == before.kept && before.region.answered()) {
        CHECK(w.region.radius >= before.region.radius);
        ++compared;
      }
      before = w;
    }
  }
  CHECK(compared > 1000);
}

TEST_CASE("witnesses tell too few rows from a refutation, and refuse what has no meaning") {
  const Vector y = Vector::Ones(3);
  const Matrix C = Matrix::Ones(3, 1);
  const Vector R = Vector::Ones(3);
  const auto rows = given_rows(y, C, R, Vector(), {}).rows;
  const Levels levels = gaussian_levels(1e-6, 3, 1);
  CHECK(leverage_ball(rows, {3, levels, false, nullptr, {}}).region.radius == kInfinity);
  CHECK(witness_subsets(rows, {3, levels, false, nullptr, {}}).region.radius == kInfinity);
  CHECK(
      leverage_ball(given_rows(y, Matrix::Zero(3, 1), R, Vector(), {}).rows, {0, levels, false, nullptr, {}})
          .region.radius == kInfinity);
  const std::vector<int> two{0, 1};
  CHECK(leverage_ball(rows, {1, levels, false, nullptr, two}).region.refuted());
  CHECK(witness_subsets(rows, {1, levels, false, nullptr, two}).region.refuted());
  const std::vector<int> twice{1, 1};
  CHECK_THROWS_AS(leverage_ball(rows, {2, levels, false, nullptr, twice}), InvalidInput);
  const std::vector<int> outside{3};
  CHECK_THROWS_AS(leverage_ball(rows, {2, levels, false, nullptr, outside}), InvalidInput);
  CHECK_THROWS_AS(leverage_ball(rows, {-1, levels, false, nullptr, {}}), InvalidInput);
  CHECK_THROWS_AS(leverage_ball(rows, {1, {kNaN, 1.0}, false, nullptr, {}}), InvalidInput);
  CHECK_THROWS_AS(witness_subsets(rows, {1, levels, false, nullptr, {}}, kNaN, 2), InvalidInput);  // 3 sets
  CHECK_THROWS_AS(witness_subsets(rows, {1, levels, true, nullptr, {}}), InvalidInput);
  CHECK_THROWS_AS(given_rows(y, C, Vector::Zero(3), Vector(), {}), InvalidInput);
  CHECK_THROWS_AS(given_rows(y, C, Vector::Ones(2), Vector(), {}), InvalidInput);
  CHECK_THROWS_AS(given_rows(y, C, R, Vector(), two), InvalidInput);
  CHECK_THROWS_AS(Rows(0, 1, 1), InvalidInput);
  CHECK_THROWS_AS(LeverageWorkspace(1, 0, 1), InvalidInput);
}

TEST_CASE("nearly parallel rows far from the origin: rounding does not lose the truth") {
  test::Rng rng(kSeed + 5);
  double largest = 0.0;
  int answered = 0;
  for (int k = 0; k < 3000; ++k) {
    CAPTURE(k);
    Sample d = draw(rng, 2, 8, 0, false);
    const Vector main = test::unit_vector(rng, 2);
    const double angle = std::pow(10.0, test::uniform(rng, -5.0, -1.0));
    const Vector toward = test::unit_vector(rng, 2);
    for (Eigen::Index j = 0; j < d.y.size(); ++j) {
      d.C.row(j) = (main + angle * test::unit_vector(rng, 2)).transpose();
      d.R(j) = 1.0;
    }
    d.x *= 1e6;
    d.width.setConstant(1e-2);
    d.y = d.C * d.x;
    for (Eigen::Index j = 0; j < d.y.size(); ++j) d.y(j) += d.C.row(j).dot(toward) < 0.0 ? -1e-2 : 1e-2;
    const Witness w = leverage_ball(d.rows().rows, {0, {}, true, nullptr, {}});
    REQUIRE_FALSE(w.region.refuted());
    if (!w.region.answered()) continue;
    ++answered;
    CHECK((d.x - w.region.center).norm() <= w.region.radius);
    largest = std::max(largest, (d.x - w.region.center).norm() / w.region.radius);
  }
  CHECK(answered > 2500);
  std::cout << "W2, nearly parallel rows: largest error/bound " << largest << '\n';
}
