// SPDX-License-Identifier: Apache-2.0
// The parameters of every family whose rounds average estimates.
#pragma once

#include <tuple>

#include "garrison/core/params.hpp"

namespace garrison {

struct ConsensusParams {
  int rounds = 3;
  double step = kNaN;
  bool chebyshev = false;
};

/// Their descriptions.
inline auto consensus_fields() {
  using P = ConsensusParams;
  return std::make_tuple(
      field(&P::rounds, {.name = "rounds",
                         .symbol = "L",
                         .unit = "1",
                         .doc = "consensus rounds per sample",
                         .least = 0,
                         .most = 1e6}),
      field(&P::step, {.name = "step",
                       .symbol = "alpha",
                       .unit = "1",
                       .doc = "consensus step; left out: 2/(lambda_2 + lambda_max)",
                       .least = 0.0}),
      field(&P::chebyshev,
            {.name = "chebyshev",
             .symbol = "",
             .unit = "",
             .doc = "Chebyshev-filtered rounds: stronger contraction from the same messages"}));
}

}  // namespace garrison
