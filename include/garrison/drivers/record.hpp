// SPDX-License-Identifier: Apache-2.0
// What came out of a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "garrison/certificate/online/doubts.hpp"
#include "garrison/engine/link.hpp"
#include "garrison/kernel/pages.hpp"

namespace garrison {

/// Arrays are C-ordered [trial][time][agent]([state] or as said); time runs 0..steps, 0 being the start.
/// An array that was not asked for is empty. NaN = does not exist.
struct GARRISON_EXPORT Record {
  int trials = 0;
  int steps = 0;
  int agents = 0;
  int states = 0;
  int outputs = 0;          ///< measurements of one sample
  int first_sample = 1;     ///< 0 for families that have a sample at the start too
  bool own_states = false;  ///< every agent has a state of its own
  std::vector<std::string> signal_names;
  std::vector<std::string> detail_names;

  Bulk<double> truth;         ///< [trial][time][state] or [trial][time][agent][state]; empty when not known
  Bulk<double> measurements;  ///< [trial][time first_sample..steps][measurement], as the filter received them
  Bulk<double> estimate;      ///< [trial][time][agent][state]
  Bulk<double> error;         ///< ||estimate - truth||; empty when the truth is not known
  Bulk<double> bound;         ///< certified bound on the error; NaN or infinite as its kind says
  Bulk<double> box;           ///< [trial][time][agent][state]: the bound of each coordinate
  Bulk<double> published;     ///< the family's own bound alone; empty without a certificate
  Bulk<std::uint8_t> bound_kind;  ///< values of CertificateKind
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
  /// The same of the sources (Plan::source) that each agent's certificate with memory has shown to be
  /// attacked.
  std::vector<Accusation> proved;
  /// What an agent's data of a trial say against its certificate with memory; where they say nothing, none.
  struct Doubted {
    int trial;
    int agent;
    certificate::Doubts doubts;
  };
  std::vector<Doubted> doubted;

  /// Lists that the family tells of its agents (sets, gains), whenever one of them changed.
  struct Detail {
    int trial;
    int time;
    int agent;
    int name;  ///< index into detail_names
    std::vector<double> values;
  };
  std::vector<Detail> details;

  LinkCounters link;
  std::int64_t missing = 0;           ///< measurements that were NaN
  std::int64_t nonfinite = 0;         ///< measurements that were infinite or beyond kHuge
  std::int64_t overflows = 0;         ///< samples with an estimate that was not finite, or beyond kHuge
  std::int64_t resets = 0;            ///< agents that rejoined because of that, over all samples
  unsigned refuted = 0;               ///< assumptions that some agent refuted: Runner::refuted of all trials
  std::vector<std::string> warnings;  ///< of the family, for people
  bool interrupted = false;           ///< stopped by the caller before the end
  /// Of the bodies of all messages of one sample, when none is lost: mean over trials.
  std::int64_t bytes_per_step = 0;
};

}  // namespace garrison
