// SPDX-License-Identifier: Apache-2.0
// Reading the cases of family he_secure and comparing with their tolerance.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "garrison/filters/saturation/setting.hpp"

namespace garrison::saturation::cases {

using Json = nlohmann::json;

inline Json load(const std::string& name) {
  std::ifstream file(std::string(GARRISON_CASES) + "/saturation/he_secure_" + name + ".json");
  REQUIRE_MESSAGE(file.good(), name);
  return Json::parse(file);
}

inline double number(const Json& j) {
  if (!j.is_string()) return j.get<double>();
  return j == "nan" ? kNaN : j == "inf" ? kInfinity : -kInfinity;
}

inline std::vector<double> numbers(const Json& j) {
  std::vector<double> all;
  for (const auto& one : j) all.push_back(number(one));
  return all;
}

/// Agreement as the cases define it: relative to the largest entry of the field; nan, inf exactly.
inline bool agree(const std::vector<double>& got, const std::vector<double>& expected,
                  double tolerance = 1e-9) {
  if (got.size() != expected.size()) return false;
  double scale = 0.0;
  for (const double e : expected)
    if (std::isfinite(e)) scale = std::max(scale, std::abs(e));
  for (std::size_t k = 0; k < got.size(); ++k) {
    if (std::isfinite(expected[k])
            ? !(std::abs(got[k] - expected[k]) <= tolerance * scale + 1e-12)
            : !(got[k] == expected[k] || (std::isnan(got[k]) && std::isnan(expected[k]))))
      return false;
  }
  return true;
}

inline bool agree(double got, const Json& expected, double tolerance = 1e-9) {
  return agree(std::vector{got}, {number(expected)}, tolerance);
}

/// Setting from an object `constants` or `bounds`; `gamma` may come from elsewhere.
inline Setting setting_of(const Json& j, double gamma) {
  return {.agents = j["N"],
          .a = j["normA"],
          .lambda0 = j["lambda0"],
          .contraction = std::pow(gamma, j["L"].get<int>()),
          .attacked = j["s"],
          .beta = j["beta"],
          .eta0 = j["eta0"],
          .b_w = j["b_w"],
          .b_v = j["b_v"]};
}
inline Setting setting_of(const Json& j) { return setting_of(j, j["gamma"]); }

/// The four bounds objects.
inline std::vector<Json> bounds_objects() {
  const Json c12 = load("12_complete_and_rank_deficient")["expected"];
  return {load("04_hard_attack_bounds")["expected"]["bounds"],
          load("09_theorem5_convergence")["expected"]["bounds"], c12["ok"], c12["rank_deficient"]};
}

}  // namespace garrison::saturation::cases
