// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/steady_state.hpp"

#include <algorithm>

#include "newton.hpp"
#include "sweeps.hpp"

namespace garrison::rdkf {
namespace {

void require_start(const Setting& s, const std::vector<Matrix>& P) {
  if (static_cast<int>(P.size()) != s.agents())
    refuse("P", amount(P.size(), "matrix", "matrices"), std::to_string(s.agents()) + ", one per agent");
  for (std::size_t i = 0; i < P.size(); ++i)
    if (P[i].rows() != s.states() || P[i].cols() != s.states() || !P[i].allFinite())
      refuse("P[" + std::to_string(i) + "]",
             std::to_string(P[i].rows()) + " x " + std::to_string(P[i].cols()) + " or not finite",
             "a finite positive semidefinite matrix, as many rows as states");
}

/// Solves (5) for out.P.
void solve(const Setting& s, const std::vector<Matrix>& seen, const SteadyOptions& options,
           SteadyState& out) {
  const int quick = std::min(kQuickSweeps, options.most_sweeps);
  if (options.borders != nullptr) {
    if (settle(s, seen, options.tolerance, quick, *options.borders, out)) return;
    refuse("model", "covariances that still change after " + std::to_string(out.sweeps) + " sweeps",
           "a pair (A, C) with which they settle",
           "Newton's method, which such plants need, is for networks that one process holds");
  }
  if (settle(s, seen, options.tolerance, quick, out) || newton(s, out) ||
      settle(s, seen, options.tolerance, options.most_sweeps - out.sweeps, out) || finish(s, out))
    return;
  refuse("model",
         "covariances that still change by " + text(out.change) + " after " + std::to_string(out.sweeps) +
             " sweeps",
         "a pair (A, C) that is detectable with some margin within so many samples, and process noise of at "
         "least about 1e-14 of what the measurements tell",
         "take a longer period where states integrate each other, raise process_covariance where it is "
         "small, or leave out what is hardly seen");
}

}  // namespace

std::vector<Matrix> riccati_sweep(const Setting& s, const std::vector<Matrix>& P) {
  require_start(s, P);
  return sweep(s, P);
}

SteadyState steady_state(const Setting& s, const SteadyOptions& options) {
  const auto n = s.states();
  const std::vector<Matrix> seen = measured(s);
  SteadyState out;
  out.P = options.start.empty() ? std::vector<Matrix>(s.C.size(), Matrix::Zero(n, n)) : options.start;
  require_start(s, out.P);
  solve(s, seen, options, out);
  for (std::size_t j = 0; j < s.C.size(); ++j) out.Pbar.push_back(predicted(s, j, out.P[j]));
  out.Q = fused(s, out.P);
  return out;
}

}  // namespace garrison::rdkf
