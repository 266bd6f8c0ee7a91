// SPDX-License-Identifier: Apache-2.0
// What came out of a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "garrison/runtime/bulk.hpp"
#include "garrison/runtime/link.hpp"

namespace garrison {

/// Arrays are C-ordered [trial][time][agent]([state] or as said); time runs 0..steps, 0 being the start.
/// An array that was not asked for is empty. NaN = does not exist.
struct GARRISON_EXPORT Record {
  int trials = 0;
  int steps = 0;
  int agents = 0;
  int states = 0;
  std::vector<std::string> signal_names;

  Bulk<double> truth;         ///< [trial][time][state]; empty when not known
  Bulk<double> measurements;  ///< [trial][time 1..steps][measurement], as the filter received them
  Bulk<double> estimate;      ///< [trial][time][agent][state]
  Bulk<double> error;         ///< ||estimate - truth||; empty when the truth is not known
  Bulk<double> bound;         ///< certified bound on the error; NaN when agents lie in messages
  Bulk<double> statistic;
  Bulk<double> threshold;
  Bulk<std::uint8_t> verdict;  ///< values of Verdict
  Bulk<double> signals;        ///< [trial][time][signal][agent]

  /// The sets of agents believed to be attacked, whenever one of them changed (and at time 0).
  struct Accusation {
    int trial;
    int time;
    std::vector<std::vector<int>> sets;  ///< per agent, sorted
  };
  std::vector<Accusation> accusations;

  LinkCounters link;
  std::int64_t missing = 0;    ///< measurements that were NaN
  std::int64_t nonfinite = 0;  ///< measurements that were infinite or beyond kHuge
  std::int64_t overflows = 0;  ///< steps with an estimate that was not finite
  bool interrupted = false;    ///< stopped by the caller before the end
};

}  // namespace garrison
