// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/theorems.hpp"

#include "filters/saturation/cases.hpp"
#include "filters/saturation/random_setting.hpp"

namespace garrison::saturation {
namespace {

using namespace cases;

/// A number that the file has only under a condition.
bool agree_or_absent(double got, const Json& j, const char* key) {
  return j.contains(key) ? agree(got, j[key]) : std::isnan(got);
}
bool agree_or_absent(const std::vector<double>& got, const Json& j, const char* key) {
  return j.contains(key) ? agree(got, numbers(j[key])) : got.empty();
}

TEST_CASE("saturation theorems: bounds of cases 04, 09, 12") {
  for (const Json& j : bounds_objects()) {
    const Setting s = setting_of(j);
    const TheoremBounds b = theorem_bounds(s, j["varpi"], static_cast<int>(j["rho"].size()) - 1);
    CHECK(b.cond9 == j["cond9"].get<bool>());
    CHECK(agree_or_absent(b.thm1_item1, j, "thm1_item1_t0_1"));
    CHECK(agree_or_absent(b.thm1_item2, j, "thm1_item2_t0_1"));
    CHECK(agree_or_absent(b.thm1_item3, j, "thm1_item3"));
    CHECK(agree_or_absent(b.prop2_f, j, "prop2_f"));
    CHECK(agree_or_absent(b.cond12_margin, j, "cond12_margin_t0_1"));
    CHECK(b.cond12 == j.value("cond12_t0_1", false));
    CHECK(agree_or_absent(b.thm3_item2, j, "thm3_item2_t0_1"));
    CHECK(agree_or_absent(b.thm3_item3, j, "thm3_item3"));
    CHECK(j["varpi"].get<double>() <= varpi_bound(s) * (1 + 1e-12));

    const MatrixG G = theorem5(s, j["tau0"], j["varpi"]);
    CHECK(agree({G.g11, G.g12, G.g21, G.g22}, {j["G"][0][0], j["G"][0][1], j["G"][1][0], j["G"][1][1]}));
    CHECK(agree(G.spectral_radius, j["G_spectral_radius"]));
  }
}

TEST_CASE("saturation theorems: theorem 4 of cases 04, 09, 12") {
  for (const Json& j : bounds_objects()) {
    const auto list = theorem4(setting_of(j), 3);
    REQUIRE(list.size() == (j.contains("thm4") ? j["thm4"].size() : 0));
    for (std::size_t d = 0; d < list.size(); ++d) {
      const Json& e = j["thm4"][d];
      CHECK(list[d].d == e["d"].get<int>());
      CHECK(agree(list[d].rho_T, e["rho_T"]));
      CHECK(agree(list[d].qbar, e["qbar"]));
      CHECK(agree(list[d].rhobar_limit, e["rhobar_limit"]));
      CHECK(agree(list[d].F_star, e["F_star"]));
      CHECK(agree(list[d].W, e["W"]));
      CHECK(agree(list[d].tight, e["tight"]));
    }
  }
}

TEST_CASE("saturation theorems: order of the bounds, 3000 random settings") {
  RandomSettings random(3);
  int with9 = 0, with12 = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    CAPTURE(trial);
    const Setting s = random.next();
    const TheoremBounds b = theorem_bounds(s, varpi_bound(s), 40);
    const auto detected = theorem4(s, 3);
    CHECK(b.cond9 == !detected.empty());
    if (!b.cond9) {
      CHECK(b.thm1_item1.empty());
      CHECK(std::isnan(b.thm1_item3));
      continue;
    }
    ++with9;
    const std::vector<double> rho = rho_sequence(s, 40);
    for (int t = 1; t <= 40; ++t) {
      const double exact = rho[static_cast<std::size_t>(t)] + p_at(s, t);
      CHECK(b.thm1_item1[static_cast<std::size_t>(t - 1)] >= exact * (1 - 1e-12));
      CHECK(exact <= b.thm1_item2 * (1 + 1e-12));
    }
    CHECK(b.thm1_item3 <= b.thm1_item2 * (1 + 1e-12));
    if (std::isfinite(b.prop2_f) && s.a >= 1.0) CHECK(b.prop2_f >= b.thm1_item3 * (1 - 1e-12));
    CHECK(b.thm1_item3 <= (rho.back() + constants(s).p0) * (1 + 1e-9));
    if (b.cond12) {
      ++with12;
      CHECK(b.thm3_item3 <= b.thm1_item3 * (1 + 1e-9));
    }
    for (std::size_t d = 0; d < detected.size(); ++d) {
      if (std::isfinite(detected[d].W)) CHECK(detected[d].W >= detected[d].tight * (1 - 1e-9) - 1e-12);
      if (d > 0) CHECK(detected[d].tight <= detected[d - 1].tight * (1 + 1e-12));
    }
  }
  CHECK(with9 > 500);
  CHECK(with12 > 100);
}

TEST_CASE("saturation theorems: absent bounds and bad input") {
  const Setting good{.agents = 8,
                     .a = 1.01,
                     .lambda0 = 3,
                     .contraction = 0.002,
                     .attacked = 1,
                     .beta = 3.3,
                     .eta0 = 2,
                     .b_w = 0.01,
                     .b_v = 0.01};
  const TheoremBounds unknown = theorem_bounds(good, kNaN, 5);
  CHECK(unknown.cond12);
  CHECK(unknown.thm3_item2.empty());
  CHECK(std::isnan(unknown.thm3_item3));
  CHECK(std::isnan(theorem_bounds(good, 1.0, 5).thm3_item3));
  Setting few = good;
  few.contraction = 0.995;
  CHECK_FALSE(theorem_bounds(few, 0.6, 5).cond9);
  CHECK(theorem4(few, 3).empty());
  CHECK_THROWS_AS(theorem_bounds(good, -0.1, 5), InvalidInput);
  CHECK_THROWS_AS(theorem_bounds(good, 0.6, 0), InvalidInput);
  CHECK_THROWS_AS(theorem4(good, -1), InvalidInput);
  CHECK_THROWS_AS(theorem5(good, kInfinity, 0.6), InvalidInput);
  CHECK(std::isnan(theorem5(good, kNaN, 0.6).spectral_radius));
}

}  // namespace
}  // namespace garrison::saturation
