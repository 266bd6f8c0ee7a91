// SPDX-License-Identifier: Apache-2.0
// Bytes that certificates add to a sample without losses in which everybody learns everything. Internal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flood.hpp"
#include "garrison/certificate/online/evidence.hpp"
#include "garrison/certificate/online/plan.hpp"

namespace garrison::detail {

/// What agents would send (AgentCertifier::say), counted without sending it. Nothing is allocated after
/// construction.
/// Threads: one at a time.
class EvidenceBytes {
 public:
  EvidenceBytes() = default;
  /// listeners, said: of each agent; what is said in its shape, for all rounds. Flooded, `flood` is kept.
  EvidenceBytes(const certificate::Plan& plan, std::vector<int> listeners, int rounds, const Flood& flood,
                std::span<const certificate::Evidence> said);

  /// y: all measurements, agent by agent. relaying: all have a region already.
  std::int64_t flooded(const double* y, bool relaying);
  /// Local and direct; told: of each agent's measurements; since: the first round in which it has a region to
  /// relay, rounds = none.
  std::int64_t local(const double* y, std::span<const certificate::Told> told,
                     std::span<const int> since) const;

 private:
  bool same_pattern(const double* y, bool relaying);
  int spoken_rounds(int agent);

  const certificate::Plan* plan_ = nullptr;
  const Flood* flood_ = nullptr;
  int rounds_ = 0;
  std::vector<int> listeners_;
  std::vector<std::int64_t> bare_;  // of a message of each agent, numbers aside
  std::int64_t region_ = 0;         // the numbers of a region
  // Flooded.
  std::vector<std::int64_t> travelled_;  // of each measurement, wherever it is passed on
  std::vector<char> present_;            // measurements of the sample before
  bool relaying_ = false;                // in it
  std::int64_t bare_all_ = -1;           // of it
  std::vector<char> has_, spoken_;       // agents with a measurement; rounds of the agent at hand
};

}  // namespace garrison::detail
