// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/design.hpp"

#include "filters/saturation/cases.hpp"
#include "filters/saturation/random_setting.hpp"

namespace garrison::saturation {
namespace {

using namespace cases;

constexpr double kGamma = 0.9256414492364503;
double plain(int L) { return std::pow(kGamma, L); }

Setting paper(int s, int L, double eta0) {
  return {.agents = 30,
          .a = 1.0512492197250394,
          .lambda0 = 12.0 - s,
          .contraction = plain(L),
          .attacked = s,
          .eta0 = eta0,
          .b_w = 0.02,
          .b_v = 0.01};
}

/// J(beta) of case 08; `give`: relative slack on eta0 <= rho_hi.
double bound_at(Setting s, double beta, double give = 0.0) {
  s.beta = beta;
  const FixedPoints points = fixed_points(s);
  return s.eta0 <= points.hi * (1.0 + give) ? points.lo + constants(s).p0 : kInfinity;
}

TEST_CASE("saturation design: case 08") {
  const Json rows = load("08_design")["expected"]["rows"];
  for (const Json& row : rows) {
    CAPTURE(row.dump());
    const Setting s = paper(row["s"], row["L"], row["eta0"]);
    CHECK(agree(s.lambda0, row["lambda0"]));
    const Json& expected = row["design"];
    if (expected.is_null()) {
      CHECK_THROWS_AS(best_threshold(s), DesignInfeasible);
      continue;
    }
    const Threshold best = best_threshold(s, 0.0);
    CHECK(agree(best.beta, expected["beta"], 1e-6));
    CHECK(agree(best.bound, expected["bound"], 1e-6));
    CHECK(agree(best.admissible.lo, expected["beta_lo"], 1e-6));
    CHECK(agree(best.admissible.hi, expected["beta_hi"], 1e-6));
    CHECK(agree(bound_at(s, expected["beta"], 1e-9), row["bound_at_design_beta"], 1e-6));
    CHECK(best.eta0 == s.eta0);
    const Threshold safe = best_threshold(s);
    CHECK(safe.beta == doctest::Approx(best.beta * (1 + kEdgeMargin)).epsilon(1e-8));
  }
}

TEST_CASE("saturation design: best threshold against a scan, 1500 random settings") {
  RandomSettings random(7);
  int edge = 0, interior = 0, infeasible = 0, enlarged = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    CAPTURE(trial);
    const Setting s = random.next();
    double least = kInfinity;
    for (double beta = 1e-7; beta < 1e9; beta *= 1.01) least = std::min(least, bound_at(s, beta));
    try {
      const Threshold best = best_threshold(s, 0.0);
      CHECK(best.bound <= least * (1 + 1e-9));
      CHECK(bound_at(s, best.beta) == doctest::Approx(best.bound).epsilon(1e-12));
      if (best.beta > 1e-7 && best.beta < 1e9)
        CHECK(least <= bound_at(s, best.beta * 1.01) * (1 + 1e-9) + 1e-12);
      (std::isinf(bound_at(s, best.beta * (1 - 1e-6))) ? edge : interior) += 1;
      Setting run = s;
      run.beta = best.beta * (1 + 1e-9);
      run.eta0 = best.eta0;
      enlarged += best.eta0 > s.eta0;
      if (best.eta0 == s.eta0) CHECK(constants(run).cond9);
    } catch (const DesignInfeasible&) {
      ++infeasible;
      // Either nothing is admissible, or the bound falls all the way to beta = 0.
      if (std::isfinite(least)) {
        CHECK(s.a <= 1.0);
        CHECK(bound_at(s, 1e-9) <= least * (1 + 1e-6) + 1e-9);
      }
    }
  }
  CHECK(enlarged > 100);
  CHECK(edge > 100);
  CHECK(interior > 100);
  CHECK(infeasible > 100);
}

TEST_CASE("saturation design: an enlarged eta0 satisfies (9)") {
  RandomSettings random(8);
  int enlarged = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    CAPTURE(trial);
    Setting s = random.next();
    s.eta0 *= 1e-3;
    try {
      const Threshold best = best_threshold(s);
      s.beta = best.beta;
      s.eta0 = best.eta0;
      CHECK(constants(s).cond9);
      ++enlarged;
    } catch (const DesignInfeasible&) {
    }
  }
  CHECK(enlarged > 300);
}

TEST_CASE("saturation design: rounds and threshold together") {
  const Setting s = paper(3, 1, 50.0);
  const Design all = design_rounds_and_threshold(s, plain, 1, 90);
  CHECK(all.fewest_rounds == 50);
  CHECK(all.rounds == 90);
  CHECK(all.contraction == plain(90));
  CHECK(all.threshold.bound ==
        doctest::Approx(5.58).epsilon(0.002));  // best fixed beta, docs/filters/saturation.md#s-adaptive

  const Design thrifty = design_rounds_and_threshold(s, plain, 1, 400, 0.01);
  const Design best = design_rounds_and_threshold(s, plain, 1, 400);
  CHECK(thrifty.rounds < best.rounds);
  CHECK(thrifty.threshold.bound <= 1.01 * best.threshold.bound);
  CHECK(best_threshold(paper(3, thrifty.rounds - 1, 50.0)).bound > 1.01 * best.threshold.bound);
  for (int L = 50; L <= 400; ++L)
    CHECK(best_threshold(paper(3, L, 50.0)).bound >= best.threshold.bound * (1 - 1e-9));
  CHECK(design_rounds_and_threshold(s, plain, 300, 400, 0.5).rounds == 300);
}

TEST_CASE("saturation design: infeasible designs say why, with the number") {
  const auto fails = [](const Setting& s, int most, const char* words) {
    CHECK_THROWS_WITH_AS(design_rounds_and_threshold(s, plain, 1, most), doctest::Contains(words),
                         DesignInfeasible);
  };
  fails(paper(6, 1, 50.0), 500, "a = 1.0512492197250394 but must be < N/(N - lambda0 + s) = 1;");
  fails(paper(5, 1, 50.0), 74, "at most 74 allowed, the smallest feasible L is 75");
  CHECK_THROWS_WITH_AS(best_threshold(paper(5, 60, 50.0)), doctest::Contains("L is too small"),
                       DesignInfeasible);
  Setting loose = paper(0, 1, 1.0);
  loose.a = 1.5;
  loose.contraction = 0.9;
  CHECK_THROWS_WITH_AS(best_threshold(loose), doctest::Contains("||A|| gamma^L = 1.35"), DesignInfeasible);
  Setting stable = paper(15, 90, 1.0);
  stable.lambda0 = 0.0;
  stable.a = 0.5;
  CHECK_THROWS_WITH_AS(best_threshold(stable), doctest::Contains("falls as beta -> 0"), DesignInfeasible);

  CHECK_THROWS_AS(best_threshold(paper(3, 90, 0.0)), InvalidInput);
  CHECK_THROWS_AS(best_threshold(paper(3, 90, 1.0), -1.0), InvalidInput);
  CHECK_THROWS_AS(design_rounds_and_threshold(paper(3, 90, 1.0), plain, 0, 5), InvalidInput);
  CHECK_THROWS_AS(design_rounds_and_threshold(paper(3, 90, 1.0), plain, 6, 5), InvalidInput);
}

}  // namespace
}  // namespace garrison::saturation
