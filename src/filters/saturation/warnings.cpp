// SPDX-License-Identifier: Apache-2.0
// What a run of the saturation filter says of its own assumptions.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "garrison/filters/saturation/filter.hpp"

namespace garrison {
namespace {

/// The verdicts of one trial: a proof is for ever, so one that was taken back was refuted.
struct Story {
  int attacked = 0;  ///< sensors that were called attacked at some sample
  bool taken_back = false;
};

Story story(const VerdictLog& log, int trial) {
  Story out;
  const auto size = static_cast<std::size_t>(log.times) * static_cast<std::size_t>(log.agents);
  const auto all = log.verdict.subspan(static_cast<std::size_t>(trial) * size, size);
  constexpr auto kAttacked = static_cast<std::uint8_t>(Verdict::attacked);
  if (std::find(all.begin(), all.end(), kAttacked) == all.end()) return out;
  for (int i = 0; i < log.agents; ++i) {
    bool ever = false;
    for (int t = 0; t < log.times; ++t) {
      const auto at =
          static_cast<std::size_t>(t) * static_cast<std::size_t>(log.agents) + static_cast<std::size_t>(i);
      const bool now = all[at] == kAttacked;
      out.taken_back = out.taken_back || (ever && !now);
      ever = ever || now;
    }
    out.attacked += ever ? 1 : 0;
  }
  return out;
}

std::vector<std::string> refutations(const VerdictLog& log) {
  int trials = 0;
  int most = 0;
  for (int trial = 0; trial < log.trials; ++trial) {
    const Story one = story(log, trial);
    trials += one.taken_back ? 1 : 0;
    most = one.taken_back ? std::max(most, one.attacked) : most;
  }
  if (trials == 0) return {};
  return {"the filter found " + amount(most, "sensor") + " attacked, more than `attacked` allows (" +
          std::to_string(trials) + " of " + amount(log.trials, "trial") +
          "): an assumption is false, so no accusation of this run is a proof. Either attacked is too "
          "small, the set of attacked sensors changed over time, measurement_bound or process_bound is too "
          "small, A or C is wrong, or the start was farther off than initial_error"};
}

/// The first sample in which more than `most` sensors said nothing; 0 = none.
int first_gap(const Model& model, const VerdictLog& log, int most) {
  int first = 0;
  std::size_t at = 0;
  for (int trial = 0; trial < log.trials; ++trial)
    for (int t = 0; t < log.times; ++t) {
      int silent = 0;
      for (int i = 0; i < log.agents; ++i, ++at)
        silent +=
            model.outputs(i) > 0 && log.verdict[at] == static_cast<std::uint8_t>(Verdict::silent) ? 1 : 0;
      if (t > 0 && silent > most && (first == 0 || t < first)) first = t;
    }
  return first;
}

}  // namespace

std::vector<std::string> Saturation::warnings(const Params& params, const Model& model,
                                              const VerdictLog& log) {
  if (log.verdict.empty()) return {};
  std::vector<std::string> all = refutations(log);
  if (!params.detector && std::isnan(params.initial_error)) return all;  // nothing was claimed
  if (const int first = first_gap(model, log, params.attacked); first > 0)
    all.push_back("more than " + amount(params.attacked, "sensor") +
                  " (`attacked`) had no measurement at sample " + std::to_string(first) +
                  ": from then on the filter has no bound and proves nothing; allow for them in attacked, or "
                  "ask for a certificate");
  return all;
}

}  // namespace garrison
