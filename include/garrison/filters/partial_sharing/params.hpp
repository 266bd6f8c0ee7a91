// SPDX-License-Identifier: Apache-2.0
// Parameters of the partial-sharing filter, described once. Included by filter.hpp.
#pragma once

#include "garrison/filters/partial_sharing/filter.hpp"

namespace garrison {

inline auto PartialSharing::Params::fields() {
  return std::make_tuple(
      field(&Params::gain,
            {.name = "gain",
             .symbol = "gamma",
             .unit = "1",
             .doc = "factor of the consensus gain C_i = gamma (A - K_i H_i) P_i; see the stability "
                    "tests of check",
             .required = true,
             .least = 0.0,
             .most = 1e6}),
      field(&Params::shared, {.name = "shared",
                              .symbol = "l",
                              .unit = "entries",
                              .doc = "entries of the estimate that every agent sends per sample; 0 = all",
                              .least = 0}),
      field(&Params::shared_each, {.name = "shared_each",
                                   .symbol = "l_i",
                                   .unit = "entries",
                                   .doc = "the same, one number per agent; overrides shared",
                                   .least = 1}),
      field(&Params::selection,
            {.name = "selection",
             .symbol = "s_i(0)",
             .unit = "",
             .doc = "which entries every agent sends first: zeros and ones, agent by agent, one "
                    "per state; overrides shared, shared_each and starts",
             .least = 0.0,
             .most = 1.0}),
      field(&Params::starts, {.name = "starts",
                              .symbol = "",
                              .unit = "",
                              .doc = "first selections: \"random\" subsets (uncoordinated, the paper), or "
                                     "\"coordinated\": everybody begins with the first entries",
                              .choices = {"random", "coordinated"}}),
      field(&Params::selection_seed, {.name = "selection_seed",
                                      .symbol = "",
                                      .unit = "",
                                      .doc = "seed of the random first selections",
                                      .least = 0}),
      field(&Params::shift,
            {.name = "shift",
             .symbol = "tau",
             .unit = "entries",
             .doc = "circular shift of all selections per sample; any whole number. Without a common "
                    "factor with the number of states every entry has its turn"}),
      field(&Params::start_variance, {.name = "start_variance",
                                      .symbol = "P_0",
                                      .unit = "state^2",
                                      .doc = "P_0 = start_variance I",
                                      .least = 0.0,
                                      .most = 1e100}),
      field(&Params::start_covariance, {.name = "start_covariance",
                                        .symbol = "P_0",
                                        .unit = "state^2",
                                        .doc = "P_0 row by row, symmetric positive semidefinite; overrides "
                                               "start_variance"}),
      field(&Params::start_is_prediction, {.name = "start_is_prediction",
                                           .symbol = "",
                                           .unit = "",
                                           .doc = "the initial estimate and P_0 belong to the first "
                                                  "measurement (xhat(0) of the paper), not to the "
                                                  "sample before it"}),
      field(
          &Params::gains,
          {.name = "gains",
           .symbol = "K_i, C_i",
           .unit = "",
           .doc =
               "\"frozen\" once (11) has converged, \"varying\" for ever (same values but for "
               "rounding; in a plant that changes they follow it), or \"steady\": the limits from the start",
           .choices = {"frozen", "varying", "steady"}}));
}

}  // namespace garrison
