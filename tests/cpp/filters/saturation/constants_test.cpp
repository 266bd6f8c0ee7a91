// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/constants.hpp"

#include "core/solvers.hpp"
#include "filters/saturation/cases.hpp"
#include "filters/saturation/random_setting.hpp"
#include "garrison/filters/saturation/adaptive.hpp"
#include "garrison/filters/saturation/detector.hpp"

namespace garrison::saturation {
namespace {

using namespace cases;

std::vector<double> p_until(const Setting& s, int T) {
  std::vector<double> p;
  for (int t = 0; t <= T; ++t) p.push_back(p_at(s, t));
  return p;
}

TEST_CASE("saturation constants: p0, q0 of cases 02, 06, 11") {
  for (const char* name : {"02_paper_alg2", "06_n5_N8_stealthy", "11_star_overshoot"}) {
    CAPTURE(name);
    const Json expected = load(name)["expected"];
    const Constants k = constants(setting_of(expected["constants"]));
    CHECK(agree(k.p0, expected["constants"]["p0"]));
    CHECK(agree(k.q0, expected["constants"]["q0"]));
    if (expected.contains("cond9")) CHECK(k.cond9 == expected["cond9"].get<bool>());
  }
}

TEST_CASE("saturation constants: everything about (7)-(10) in cases 04, 09, 12") {
  for (const Json& j : bounds_objects()) {
    const Setting s = setting_of(j);
    const Constants k = constants(s);
    CHECK(agree(k.p0, j["p0"]));
    CHECK(agree(k.q0, j["q0"]));
    CHECK(agree(k.F_eta0, j["F_eta0"]));
    CHECK(agree(k.cond9_margin, j["cond9_margin"]));
    CHECK(k.cond9 == j["cond9"].get<bool>());
    const int T = static_cast<int>(j["rho"].size()) - 1;
    CHECK(agree(rho_sequence(s, T), numbers(j["rho"])));
    CHECK(agree(p_until(s, T), numbers(j["p"])));
    CHECK(agree(fixed_points(s).lo, j["rho_lo"]));
    CHECK(agree(fixed_points(s).hi, j["rho_hi"]));
  }
}

TEST_CASE("saturation constants: run-time recursions of cases 02, 04, 11") {
  const Json c04 = load("04_hard_attack_bounds")["expected"];
  const Json& adaptive = c04["adaptive_beta"];
  Setting s = setting_of(c04["bounds"]);
  s.beta = kNaN;
  std::vector<double> beta, rho{s.eta0}, p{0.0};
  for (std::size_t t = 1; t < adaptive["rho"].size(); ++t) {
    const AdaptiveStep step = adaptive_next(s, c04["bounds"]["varpi"], rho.back(), p.back());
    beta.push_back(step.beta);
    rho.push_back(step.rho);
    p.push_back(step.p);
  }
  CHECK(agree(beta, numbers(adaptive["beta"])));
  CHECK(agree(rho, numbers(adaptive["rho"])));
  CHECK(agree(p, numbers(adaptive["p"])));

  // Sensor 0 of case 11 knows the attacker from t = 1 on, sensor 1 from t = 2 on.
  const Json c11 = load("11_star_overshoot")["expected"];
  const Setting star = setting_of(c11["constants"]);
  const double q0 = constants(star).q0;
  for (const int sensor : {0, 1}) {
    std::vector<double> got_rho{star.eta0}, got_p{0.0}, got_phi, want_rho, want_phi;
    for (int t = 1; t <= 8; ++t) {
      got_phi.push_back(detection_threshold(star, got_rho.back(), got_p.back()));
      got_rho.push_back(rho_bar_next(star, q0, got_rho.back(), got_p.back(), t - 1 >= sensor + 1 ? 1 : 0));
      got_p.push_back(disagreement_next(star, got_p.back(), star.beta));
    }
    for (const auto& row : c11["rho_bar"]) want_rho.push_back(row[sensor]);
    for (const auto& row : c11["phi"]) want_phi.push_back(row[sensor]);
    CHECK(agree(got_rho, want_rho));
    CHECK(agree(got_phi, want_phi));
    CHECK(agree(got_p, numbers(c11["p"])));
    CHECK(agree(p_until(star, 8), numbers(c11["p"])));
  }
  const Json c02 = load("02_paper_alg2")["expected"];
  const Json& want = c02["runs"][0]["p"];
  CHECK(agree(p_until(setting_of(c02["constants"]), static_cast<int>(want.size()) - 1), numbers(want)));
}

/// varpi of the paper's system: 18 sensors of the position, 12 of the velocity, s of the 30 left out.
double paper_varpi(int s) {
  double varpi = 0.0;
  for (int r = 0; r <= s; ++r) {
    const Eigen::Vector2d kept(18.0 - s + r, 12.0 - r);
    Eigen::Matrix2d A;
    A << 1.0, 0.1, 0.0, 1.0;
    varpi = std::max(varpi, ((Eigen::Vector2d::Ones() - kept / 30.0).asDiagonal() * A).operatorNorm());
  }
  return varpi;
}

TEST_CASE(
    "saturation constants: the adaptive threshold reaches the figures of "
    "docs/filters/saturation.md#s-adaptive") {
  Setting s{.agents = 30, .a = 1.0512492197250394, .eta0 = 50.0, .b_w = 0.02, .b_v = 0.01};
  struct Row {
    int s, L;
    double bound;
  };
  for (const Row row : {Row{3, 90, 0.269}, Row{5, 90, 0.99}, Row{3, 60, 0.42}}) {
    s.attacked = row.s;
    s.contraction = std::pow(0.9256414492364503, row.L);
    AdaptiveStep step{0.0, s.eta0, 0.0};
    for (int t = 0; t < 5000; ++t) step = adaptive_next(s, paper_varpi(row.s), step.rho, step.p);
    CHECK(step.rho + step.p == doctest::Approx(row.bound).epsilon(0.005));
  }
}

TEST_CASE("saturation constants: geometric sum and p(t) near a g = 1") {
  CHECK(geometric_sum(1.0, 7) == 7.0);
  CHECK(geometric_sum(0.0, 1) == 1.0);
  CHECK(geometric_sum(0.0, 5) == 1.0);
  CHECK(geometric_sum(0.5, 0) == 0.0);
  CHECK(geometric_sum(2.0, 10) == doctest::Approx(1023.0).epsilon(1e-14));
  for (const double x : {1e-20, 1e-3, 0.7, 1.0 - 1e-9, 1.0 - 1e-15, 1.0 + 1e-15, 1.0 + 1e-9, 1.3}) {
    double sum = 0.0;
    for (int k = 0; k < 200; ++k) sum = sum * x + 1.0;
    CHECK(geometric_sum(x, 200) == doctest::Approx(sum).epsilon(1e-13));
  }
  Setting s{.agents = 4,
            .a = 1.25,
            .lambda0 = 2,
            .contraction = 0.8,
            .attacked = 1,
            .beta = 1,
            .eta0 = 1,
            .b_w = 0,
            .b_v = 0};
  REQUIRE(s.a * s.contraction == 1.0);
  CHECK(p_at(s, 10) == doctest::Approx(2.0 * 0.8 * 10).epsilon(1e-14));
  CHECK(std::isnan(fixed_points(s).lo));
  CHECK_THROWS_WITH_AS(constants(s), doctest::Contains("L is too small: ||A|| gamma^L = 1 >= 1"),
                       InvalidInput);
  CHECK_THROWS_AS(rho_sequence(s, 3), InvalidInput);
  CHECK_THROWS_AS(F(s, 1.0), InvalidInput);
}

TEST_CASE("saturation constants: fixed points against a scan, 4000 random settings") {
  RandomSettings random(1);
  int empty = 0, unbounded = 0, both = 0, hits9 = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Setting s = random.next();
    CAPTURE(trial);
    const Constants k = constants(s);
    const double q0 = random.coin(0.3) ? k.q0 * random.uniform(0.0, 1.0) : k.q0;
    const FixedPoints points = fixed_points(s, q0);
    const auto gap = [&](double r) { return F(s, r) * r + q0 - r; };
    if (std::isnan(points.lo))
      ++empty;
    else if (std::isinf(points.hi))
      ++unbounded;
    else
      ++both;
    for (double r = 1e-4; r < 1e7; r *= 1.07) {
      const double slack = 1e-10 * (r + q0);
      if (points.lo * (1 + 1e-9) < r && r < points.hi * (1 - 1e-9))
        CHECK(gap(r) <= slack);
      else if (!(points.lo * (1 - 1e-9) <= r && r <= points.hi * (1 + 1e-9)))
        CHECK(gap(r) >= -slack);
    }
    if (std::isfinite(points.lo)) CHECK(std::abs(gap(points.lo)) <= 1e-9 * (points.lo + q0));
    if (std::isfinite(points.hi)) CHECK(std::abs(gap(points.hi)) <= 1e-8 * (points.hi + q0));
    if (q0 == k.q0 && std::abs(k.cond9_margin) > 1e-9 * s.eta0) {
      CHECK(k.cond9 == (points.lo <= s.eta0 && s.eta0 <= points.hi));
      hits9 += k.cond9;
    }
  }
  CHECK(empty > 300);
  CHECK(unbounded > 300);
  CHECK(both > 300);
  CHECK(hits9 > 300);
}

TEST_CASE("saturation constants: sharp q0 is never larger") {
  RandomSettings random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    Setting s = random.next();
    s.sharp = false;
    const double printed = constants(s).q0;
    s.sharp = true;
    CHECK(constants(s).q0 <= printed * (1 + 1e-14));
  }
}

TEST_CASE("saturation constants: bad settings are refused by name") {
  const Setting good{.agents = 8,
                     .a = 1.01,
                     .lambda0 = 3,
                     .contraction = 0.1,
                     .attacked = 1,
                     .beta = 1,
                     .eta0 = 1,
                     .b_w = 0,
                     .b_v = 0};
  CHECK_NOTHROW(require(good));
  const auto refused = [&](auto change, const char* word) {
    Setting bad = good;
    change(bad);
    CHECK_THROWS_WITH_AS(require(bad), doctest::Contains(word), InvalidInput);
  };
  refused([](Setting& s) { s.beta = 0.0; }, "threshold (beta): got 0");
  refused([](Setting& s) { s.beta = kInfinity; }, "threshold (beta): got inf");
  refused([](Setting& s) { s.eta0 = -1.0; }, "initial_error (eta0): got -1");
  refused([](Setting& s) { s.attacked = 9; }, "expected 0..8");
  refused([](Setting& s) { s.attacked = -1; }, "attacked (s)");
  refused([](Setting& s) { s.b_w = -0.1; }, "b_w");
  refused([](Setting& s) { s.b_v = kNaN; }, "measurement_bound (b_v): got nan");
  refused([](Setting& s) { s.a = kInfinity; }, "||A||");
  refused([](Setting& s) { s.lambda0 = 7.5; }, "lambda0");
  refused([](Setting& s) { s.contraction = 1.5; }, "contraction");
  refused([](Setting& s) { s.agents = 0; }, "agents");
  CHECK_THROWS_AS(p_at(good, -1), InvalidInput);
  CHECK_THROWS_AS(rho_sequence(good, -1), InvalidInput);
  CHECK_THROWS_AS(k_star(good, -1.0), InvalidInput);
  CHECK_THROWS_AS(fixed_points(good, kNaN), InvalidInput);
}

}  // namespace
}  // namespace garrison::saturation
