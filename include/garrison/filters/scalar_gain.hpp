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

  struct Params : ConsensusParams {
    static auto fields() { return consensus_fields(); }
  };

  static Saturation::Params unsaturated(const Params& p) { return {p, kInfinity}; }
  static Gains design(const Params& p, const Model& model, const Network& network) {
    return Saturation::design(unsaturated(p), model, network);
  }
  static Check check(const Params& p, const Model& model, const Network& network) {
    return Saturation::check(unsaturated(p), model, network);
  }
};

}  // namespace garrison
