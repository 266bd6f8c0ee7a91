// SPDX-License-Identifier: Apache-2.0
// The cases of family he_secure.
#pragma once

#include <cmath>

#include "../../cases.hpp"
#include "garrison/filters/saturation/setting.hpp"

namespace garrison::saturation::cases {

using namespace garrison::cases;

inline Json load(const std::string& name) { return load_case("saturation/he_secure_" + name + ".json"); }

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
