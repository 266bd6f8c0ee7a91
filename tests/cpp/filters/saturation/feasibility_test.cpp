// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/feasibility.hpp"

#include "filters/saturation/cases.hpp"
#include "filters/saturation/random_setting.hpp"

namespace garrison::saturation {
namespace {

using namespace cases;

bool same_rounds(const std::optional<int>& got, const Json& expected) {
  return expected.is_null() ? !got : got == expected.get<int>();
}

double margin9(Setting s, double beta) {
  s.beta = beta;
  return constants(s).cond9_margin;
}

TEST_CASE("saturation feasibility: cases 04, 09, 12") {
  for (const Json& j : bounds_objects()) {
    const Setting s = setting_of(j);
    CHECK(agree(normA_max_exact(s), j["normA_max_exact"]));
    CHECK(agree(feasibility_margin(s), j["feasibility_margin"]));
    CHECK(same_rounds(minimal_rounds(s, j["gamma"].get<double>()), j["minimal_L"]));
    const Interval betas = beta_interval(s);
    CHECK(agree({betas.lo, betas.hi}, numbers(j["beta_interval"])));
  }
}

TEST_CASE("saturation feasibility: case 08, rounds and beta intervals") {
  const Json c = load("08_design");
  for (const Json& row : c["expected"]["rows"]) {
    CAPTURE(row.dump());
    const double gamma = 0.9256414492364503;
    const Setting s{.agents = 30,
                    .a = 1.0512492197250394,
                    .lambda0 = row["lambda0"],
                    .contraction = std::pow(gamma, row["L"].get<int>()),
                    .attacked = row["s"],
                    .eta0 = row["eta0"],
                    .b_w = c["inputs"]["b_w"],
                    .b_v = c["inputs"]["b_v"]};
    CHECK(same_rounds(minimal_rounds(s, gamma), row["minimal_L"]));
    const Interval betas = beta_interval(s);
    CHECK(agree({betas.lo, betas.hi}, numbers(row["beta_interval"])));
  }
}

TEST_CASE("saturation feasibility: case 07, largest norm and the paper's eps") {
  const Json c = load("07_lambda0_table");
  for (std::size_t k = 0; k < c["inputs"]["items"].size(); ++k) {
    const Json& item = c["inputs"]["items"][k];
    const Json& e = c["expected"]["items"][k];
    const Setting s{
        .agents = static_cast<int>(item["C"].size()), .lambda0 = e["lambda0"], .attacked = item["s"]};
    CHECK(agree(normA_max_exact(s), e["normA_max_exact"]));
    CHECK(condition11(s) == e["cond11"].get<bool>());
    if (e.contains("eps_paper"))
      CHECK(agree(eps_paper(s), e["eps_paper"]));
    else
      CHECK(std::isnan(eps_paper(s)));
    if (condition11(s)) CHECK(normA_max_exact(s) - 1.0 >= 2.0 * eps_paper(s) * (1 - 1e-12));
  }
}

TEST_CASE("saturation feasibility: smallest L of docs/filters/saturation.md#s6, printed and sharp") {
  struct Row {
    int s, printed, sharp;
  };
  for (const Row row : {Row{0, 41, 26}, Row{3, 50, 36}, Row{5, 75, 62}}) {
    Setting s{.agents = 30, .a = 1.0512492197250394, .lambda0 = 12.0 - row.s, .attacked = row.s};
    CHECK(minimal_rounds(s, 0.9256414492364503) == row.printed);
    s.sharp = true;
    CHECK(minimal_rounds(s, 0.9256414492364503) == row.sharp);
  }
  const Setting paper{.agents = 30, .a = 1.0512492197250394, .lambda0 = 6.0, .attacked = 6};
  CHECK_FALSE(minimal_rounds(paper, 0.9256414492364503));
}

TEST_CASE("saturation feasibility: margin against a scan over beta/eta0, 2000 random settings") {
  RandomSettings random(4);
  int positive = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    CAPTURE(trial);
    Setting s = random.next();
    const double margin = feasibility_margin(s);
    positive += margin > 0.0;
    s.b_w = s.b_v = 0.0;  // (9) per unit of eta0 is then the margin at x = beta / eta0
    s.eta0 = 1.0;
    double best = 1.0 - s.a;  // x -> 0
    for (double x = 1e-9; x < 1e3; x *= 1.02) {
      const double at = margin9(s, x);
      CHECK(at <= margin + 1e-12 * (1.0 + x));
      best = std::max(best, at);
    }
    CHECK(best >= margin - 0.02 * (std::abs(margin) + s.a * s.lambda0 / s.agents));
    // Below 1 every ||A|| is feasible with a small beta, whatever lambda0.
    s.contraction = 0.0;
    if (std::abs(feasibility_margin(s)) > 1e-12)
      CHECK((feasibility_margin(s) > 0.0) == (s.a < std::max(1.0, normA_max_exact(s))));
  }
  CHECK(positive > 300);
}

TEST_CASE("saturation feasibility: beta interval against a scan, 3000 random settings") {
  RandomSettings random(5);
  int empty = 0, closed = 0, open = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    CAPTURE(trial);
    const Setting s = random.next();
    const Interval betas = beta_interval(s);
    (std::isnan(betas.lo) ? empty : betas.lo > 0.0 ? closed : open) += 1;
    for (double beta = 1e-5; beta < 1e5; beta *= 1.05) {
      const double slack = 1e-10 * (s.eta0 + s.b_w + s.b_v + beta);
      const double at = margin9(s, beta);
      if (betas.lo * (1 + 1e-9) < beta && beta < betas.hi * (1 - 1e-9)) CHECK(at >= -slack);
      if (!(betas.lo * (1 - 1e-9) <= beta && beta <= betas.hi * (1 + 1e-9))) CHECK(at <= slack);
    }
    const double scale = s.eta0 + s.b_w + s.b_v;
    if (betas.lo > 0.0) CHECK(std::abs(margin9(s, betas.lo)) <= 1e-9 * (scale + betas.lo));
    if (std::isfinite(betas.hi)) CHECK(std::abs(margin9(s, betas.hi)) <= 1e-9 * (scale + betas.hi));
  }
  CHECK(empty > 300);
  CHECK(closed > 300);
  CHECK(open > 100);
}

TEST_CASE("saturation feasibility: smallest L against a walk, 1000 random settings") {
  RandomSettings random(6);
  int found = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    CAPTURE(trial);
    Setting s = random.next();
    const double gamma = random.coin(0.1) ? 0.0 : random.uniform(0.0, 0.98);
    const std::optional<int> rounds = minimal_rounds(s, gamma);
    int walk = 0;
    for (int L = 1; L <= 5000 && walk == 0; ++L) {
      s.contraction = std::pow(gamma, L);
      if (feasibility_margin(s) > 0.0) walk = L;
    }
    CHECK(rounds.value_or(0) == walk);
    found += walk > 1;
  }
  CHECK(found > 100);
}

TEST_CASE("saturation feasibility: too few rounds are data, bad input is refused") {
  Setting s{
      .agents = 4, .a = 1.25, .lambda0 = 3, .contraction = 0.8, .attacked = 0, .eta0 = 1, .b_w = 0, .b_v = 0};
  CHECK(feasibility_margin(s) == -kInfinity);
  CHECK(std::isnan(beta_interval(s).lo));
  CHECK(std::isnan(beta_interval(s).hi));
  CHECK_THROWS_WITH_AS(minimal_rounds(s, 1.0), doctest::Contains("connect the graph"), InvalidInput);
  CHECK_FALSE(minimal_rounds(s, [](int) { return 1.0; }));
  s.attacked = 5;
  CHECK_THROWS_AS(feasibility_margin(s), InvalidInput);
  CHECK_THROWS_AS(normA_max_exact(s), InvalidInput);
  s.attacked = 0;
  s.eta0 = 0.0;
  CHECK_THROWS_AS(beta_interval(s), InvalidInput);
}

}  // namespace
}  // namespace garrison::saturation
