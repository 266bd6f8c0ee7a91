// SPDX-License-Identifier: Apache-2.0
// The certificates of all agents of a network in one process, beside the engine of any family.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/certificate/online/evidence.hpp"
#include "garrison/certificate/online/plan.hpp"
#include "garrison/core/change.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/routes.hpp"
#include "garrison/engine/workers.hpp"

namespace garrison {
namespace certificate {
class AgentCertifier;
}

/// The engine says which messages arrived; what they carry for the certificate travels here. Agents are in
/// order of public id. The same bits as agents that are driven by bytes; nothing is allocated after
/// construction.
/// Threads: one at a time.
class GARRISON_EXPORT CertifiedNetwork {
 public:
  CertifiedNetwork(std::shared_ptr<const certificate::Plan> plan, const Network& network, int rounds);
  ~CertifiedNetwork();

  void reset(std::int64_t t);
  /// Sample t; y: all measurements, agent by agent, that stay there until `finish`. change: what of this
  /// sample is not the plan's.
  void begin(std::int64_t t, const double* y, const Change& change = {});
  /// Of families whose estimates say what was measured, before the first round: `x` is what the agent sends.
  /// All agents or none.
  bool derives() const { return plan_->derives(); }
  void derive(int agent, const double* x);
  /// Keeps places for so many messages in which agents lie. At least one, to look at.
  void keep_lies(std::size_t places);
  /// One round: everybody says what is new. Either all rounds of a sample are told so and heard, or none:
  /// then all messages arrive, and `finish` does them at once.
  void say();
  /// A copy of what `sender` says in this round, to be changed; what it has become.
  certificate::Evidence& copy(std::size_t place, int sender);
  const certificate::Evidence& lie(std::size_t place) const { return lies_[place]; }
  /// Everybody hears what `routes` deliver; sensed(place): the estimate in the message there, if `derive` was
  /// told.
  using Sensed = std::function<const double*(std::size_t place)>;
  void hear(Workers& workers, const Routes& routes, const Sensed& sensed);
  /// Ends the sample: the rounds that are left, in which all messages arrive.
  void finish(Workers& workers);

  const certificate::Certifier* of(int agent) const;
  /// Bytes that the certificate adds to the messages of a sample when none is lost: mean over all samples.
  std::int64_t bytes_per_step() const { return samples_ == 0 ? 0 : bytes_ / samples_; }

 private:
  struct Agents;
  int agents() const { return network_.agents(); }
  /// heard(k) has the k-th agent hear every message that reached it.
  template <class Heard>
  void hear_all(Workers& workers, const Heard& heard);
  bool derives_now(int sender) const;
  void hear_honest(certificate::AgentCertifier& listener, int sender) const;
  void end_round(Workers& workers);
  void start();
  void at_once(Workers& workers);

  std::shared_ptr<const certificate::Plan> plan_;
  Network network_;
  int rounds_;
  int round_ = 0;
  std::vector<int> listeners_;
  std::vector<int> first_;            // output of each agent in y
  const double* measured_ = nullptr;  // of sample t_
  const double* y_ = nullptr;         // what is used for it, while the sample has not started
  std::int64_t t_ = 0;
  std::vector<double> derived_;  // what is used for y, where `derive` was told
  std::vector<certificate::Told> told_;
  Matrix rows_;  // of sample t_, each a column, where they are not the plan's
  bool varied_ = false;
  std::unique_ptr<Agents> all_;
  std::vector<certificate::Evidence> lies_;  // in the order of the places of Routes
  std::int64_t bytes_ = 0;
  std::int64_t samples_ = 0;
};

}  // namespace garrison
