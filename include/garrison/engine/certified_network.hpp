// SPDX-License-Identifier: Apache-2.0
// The certificates of all agents of a network in one process, beside the engine of any family.
#pragma once

#include <memory>
#include <vector>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/certificate/online/plan.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/routes.hpp"
#include "garrison/engine/workers.hpp"

namespace garrison {

/// The engine says which messages arrived; what they carry for the certificate travels here. Agents are in
/// order of public id. The same bits as agents that are driven by bytes; nothing is allocated after
/// construction.
/// Threads: one at a time.
class GARRISON_EXPORT CertifiedNetwork {
 public:
  CertifiedNetwork(std::shared_ptr<const certificate::Plan> plan, const Network& network, int rounds);
  ~CertifiedNetwork();

  void reset(std::int64_t t);
  /// Sample t; y: all measurements, agent by agent, that stay there until `finish`.
  void begin(std::int64_t t, const double* y);
  /// One round in which everybody hears what `routes` deliver. Either all rounds of a sample are told so, or
  /// none: then all messages arrive, and `finish` does them at once.
  void round(Workers& workers, const Routes& routes);
  /// Ends the sample: the rounds that are left, in which all messages arrive.
  void finish(Workers& workers);

  const certificate::Certifier* of(int agent) const;
  /// Bytes that the certificate adds to the messages of a sample when none is lost: mean over all samples.
  std::int64_t bytes_per_step() const { return samples_ == 0 ? 0 : bytes_ / samples_; }

 private:
  struct Agents;
  int agents() const { return network_.agents(); }
  /// heard(k, hear) calls hear(agent, sender) for every message that reached the k-th agent.
  template <class Heard>
  void hear_all(Workers& workers, const Heard& heard);
  void say();
  void hear(int agent, int sender);
  void end_round(Workers& workers);
  void start();
  void at_once(Workers& workers);

  Network network_;
  int rounds_;
  int round_ = 0;
  std::vector<int> listeners_;
  std::vector<int> first_;     // output of each agent in y
  const double* y_ = nullptr;  // of sample t_, while it has not started
  std::int64_t t_ = 0;
  std::unique_ptr<Agents> all_;
  std::int64_t bytes_ = 0;
  std::int64_t samples_ = 0;
};

}  // namespace garrison
