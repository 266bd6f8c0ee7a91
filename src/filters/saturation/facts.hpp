// SPDX-License-Identifier: Apache-2.0
// Numbers of one model and network that design and check share. Internal.
#pragma once

#include <vector>

#include "garrison/analysis/subsets.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/filters/saturation/setting.hpp"

namespace garrison::saturation::detail {

/// Refuses parameters that contradict each other or the model.
void require_parameters(const Saturation::Params& p, const Model& model);

/// Rounds with this step contract on every connected network of such degrees: no spectrum is needed to know.
bool surely_contracts(const Network& network, double step);

/// Consensus: step, weights and contraction.
struct Rates {
  double alpha = 0.0;
  double lambda2 = kNaN;
  double lambda_max = kNaN;
  double gamma = kNaN;        ///< largest |1 - alpha lambda| over the nontrivial eigenvalues
  double contraction = kNaN;  ///< of all rounds: gamma^L, or the Chebyshev factor
  std::vector<double> omega;  ///< empty = plain
};
/// `step` NaN: 2/(lambda_2 + lambda_max). @throws InvalidInput when the step makes the rounds diverge
Rates rates(const Network& network, double step, int rounds, bool chebyshev);

/// Rows of all agents, N x n, zero for relays. Only for models with at most one output per agent.
Matrix sensor_rows(const Model& model);

/// Sensor geometry: certified values, safe in every theorem.
struct Facts {
  double a = kNaN;  ///< ||A||
  SubsetBound lambda0;
  double varpi = kNaN;  ///< exact, or the safe fallback a (1 - lambda0/N)
};
Facts facts(const Model& model, int attacked, bool with_varpi);

/// What the data-free table is made for.
DataFreeOptions table_options(const Saturation::Params& p, const Rates& rates);

Setting setting(const Saturation::Params& p, const Model& model, const Facts& facts, const Rates& rates);

}  // namespace garrison::saturation::detail
