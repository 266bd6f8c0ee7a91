// SPDX-License-Identifier: Apache-2.0
// Scalar-gain consensus filter: Algorithm 1 without saturation, the unprotected baseline.
#pragma once

#include "garrison/filters/saturation/filter.hpp"

namespace garrison {

/// xhat_i <- A xhat_i + C_i' (y_i - C_i A xhat_i), then L rounds (5). No bound: one attacked sensor can move
/// every estimate anywhere.
struct GARRISON_EXPORT ScalarGain : Saturation {
  static constexpr std::string_view name = "scalar_gain";
  static constexpr std::string_view title = "Scalar-gain consensus filter (no protection)";
  static constexpr std::string_view source =
      "Khan, Jadbabaie, Automatica 2014; baseline of the saturation paper";

  struct Params {
    int rounds = 3;
    double step = kNaN;
    bool chebyshev = false;

    static auto fields() {
      return std::make_tuple(
          field(&Params::rounds, {.name = "rounds",
                                  .symbol = "L",
                                  .unit = "1",
                                  .doc = "consensus rounds per sample",
                                  .least = 0,
                                  .most = 1e6}),
          field(&Params::step, {.name = "step",
                                .symbol = "alpha",
                                .unit = "1",
                                .doc = "consensus step; left out: 2/(lambda_2 + lambda_max)",
                                .least = 0.0}),
          field(&Params::chebyshev,
                {.name = "chebyshev",
                 .symbol = "",
                 .unit = "",
                 .doc = "Chebyshev-filtered rounds: stronger contraction from the same messages"}));
    }
  };

  static Saturation::Params unsaturated(const Params& p) {
    Saturation::Params all;
    all.threshold = kInfinity;
    all.rounds = p.rounds;
    all.step = p.step;
    all.chebyshev = p.chebyshev;
    return all;
  }
  static Gains design(const Params& p, const Model& model, const Network& network) {
    return Saturation::design(unsaturated(p), model, network);
  }
  static Check check(const Params& p, const Model& model, const Network& network) {
    return Saturation::check(unsaturated(p), model, network);
  }
};

}  // namespace garrison
