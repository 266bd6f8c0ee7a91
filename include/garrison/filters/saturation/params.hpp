// SPDX-License-Identifier: Apache-2.0
// Parameters of the saturation filter, described once. Included by filter.hpp.
#pragma once

#include "garrison/filters/saturation/filter.hpp"

namespace garrison {

inline auto Saturation::Params::fields() {
  return std::tuple_cat(
      std::make_tuple(field(&Params::threshold, {.name = "threshold",
                                                 .symbol = "beta",
                                                 .unit = "measurement",
                                                 .doc = "innovations above this are clipped; inf = never. "
                                                        "May be left out with adaptive = true",
                                                 .least = 0.0,
                                                 .open = true})),
      consensus_fields(),
      std::make_tuple(
          field(&Params::attacked,
                {.name = "attacked",
                 .symbol = "s",
                 .unit = "agents",
                 .doc = "most sensors attacked (or missing) at a time; enters bound and detector",
                 .least = 0}),
          field(&Params::initial_error,
                {.name = "initial_error",
                 .symbol = "eta0",
                 .unit = "state",
                 .doc = "bound on the distance of the common initial estimate from the "
                        "state; giving it asks for run-time error bounds",
                 .least = 0.0,
                 .open = true}),
          field(&Params::detector,
                {.name = "detector",
                 .symbol = "",
                 .unit = "",
                 .doc = "Algorithm 2: prove and isolate attacked sensors (their set must not "
                        "change over time)"}),
          field(&Params::detector_index,
                {.name = "detector_index",
                 .symbol = "d_i",
                 .unit = "",
                 .doc = "which count of proved sensors enters rhobar(t): \"t\" = d_i(t-1) "
                        "as printed, \"t+1\" = d_i(t), sharper and as sound",
                 .choices = {"t", "t+1"}}),
          field(&Params::adaptive, {.name = "adaptive",
                                    .symbol = "",
                                    .unit = "",
                                    .doc = "let the threshold follow the known bound on honest innovations "
                                           "(not in the paper; needs initial_error)"}),
          field(&Params::accuse_missing,
                {.name = "accuse_missing",
                 .symbol = "",
                 .unit = "",
                 .doc = "detector: a missing (NaN) measurement counts as proof of attack"}),
          field(
              &Params::table,
              {.name = "table",
               .symbol = "",
               .unit = "",
               .doc = "also bound errors, and with detector or adaptive threshold honest innovations, by the "
                      "data-free table (docs/certificates.md, theorem T): a bound that outlives the proof "
                      "of all attackers. Design takes the time of (agents times states)^3"}),
          field(
              &Params::recovery,
              {.name = "recovery",
               .symbol = "",
               .unit = "",
               .doc = "with table: go on after lost messages (docs/certificates.md, theorem L). The bound is "
                      "that of the table and an excess that fades once messages arrive again, and the "
                      "detector goes on testing. Agents that a loss lies behind send up to 32 bytes more"}),
          field(&Params::failure,
                {.name = "failure",
                 .symbol = "",
                 .unit = "",
                 .doc = "with table: above 0 it is that of Gaussian noise with the model's covariances, for "
                        "which no noise bounds are needed (theorem TG), and the whole run has this "
                        "probability at most that anything it says is false: a bound, or an accusation, of "
                        "any agent at any of the samples 1 to horizon",
                 .least = 0.0,
                 .most = 1.0}),
          field(&Params::horizon,
                {.name = "horizon",
                 .symbol = "",
                 .unit = "samples",
                 .doc = "with failure: the samples that it is shared by; after them the table says nothing",
                 .least = 0})));
}

}  // namespace garrison
