// SPDX-License-Identifier: Apache-2.0
// The one seam for families that can do a sample of a whole network faster than agent by agent.
#pragma once

#include <cstdint>
#include <span>

#include "garrison/engine/batch/averaging.hpp"
#include "garrison/engine/batch/side_by_side.hpp"
#include "garrison/engine/mailroom.hpp"
#include "garrison/engine/plan/consensus.hpp"
#include "garrison/engine/workers.hpp"

namespace garrison {

/// One sample of all agents over perfect links. `local(k)`, `y(k)`: Local and measurements of agent k in the
/// order of the plan. `sensed(estimate)` is called before the rounds where no messages are sent:
/// estimate(k) is what agent k would say.
template <class Gains, class Locals, class Measurements, class Sensed>
struct BatchSample {
  const Gains& gains;
  const ConsensusPlan& plan;
  Wiring wiring;
  Workers& workers;
  std::int64_t t;
  Locals local;
  Measurements y;
  Sensed sensed;
};
template <class Gains, class Locals, class Measurements, class Sensed>
BatchSample(const Gains&, const ConsensusPlan&, Wiring, Workers&, std::int64_t, Locals, Measurements, Sensed)
    -> BatchSample<Gains, Locals, Measurements, Sensed>;

/// What was done of it: nothing, so that every agent has yet to sense; all have sensed and have a message to
/// send, `plain` as in Engine::rounds; everything.
struct BatchStep {
  enum { nothing, sensed, everything } done;
  bool plain;
};

/// What a batch answers that leaves everything to the agents.
template <class F, int n>
struct AgentByAgent {
  AgentByAgent() = default;
  AgentByAgent(std::span<typename F::template State<n>>, int /*states*/) {}
  /// Once, when all agents are known.
  template <class Locals>
  void join(const Locals&) {}
  /// After `init` of all agents.
  template <class Locals>
  void start(const typename F::Gains&, const Locals&) {}
  template <class Sample>
  BatchStep step(const Sample&) {
    return {BatchStep::nothing, true};
  }
  /// The message of agent k, after a step that did no more than sense.
  void send(std::size_t, typename F::template Message<n>&) const {}
  /// The only round of a family that takes its rounds out of the agents' hands; false: it does not.
  template <class Locals, class Inboxes>
  bool fuse(const typename F::Gains&, const Locals&, const Inboxes&, Workers&) {
    return false;
  }
  /// Before gains of every agent follow another plant, and after.
  void part() {}
  void moved() {}
  /// Brings the agents' states up to date.
  void settle() {}
  /// The same, before the states move on without us.
  void release() {}
};

/// The agents of family F as one object, if F has a faster way than agent by agent; here it has none. Bits
/// are those of the agents on their own, for any number of threads; nothing is allocated after `start`.
/// Threads: one at a time.
template <class F, int n>
class Batch : public AgentByAgent<F, n> {
 public:
  using AgentByAgent<F, n>::AgentByAgent;
};

template <class F, int n>
  requires Averages<F, n>
class Batch<F, n> : public AgentByAgent<F, n> {
 public:
  Batch(std::span<typename F::template State<n>> agents, int states) : all_(agents, states) {}
  template <class Sample>
  BatchStep step(const Sample& sample) {
    const auto [finite, averaged] = all_.step(sample);
    return {averaged ? BatchStep::everything : BatchStep::sensed, finite};
  }
  void send(std::size_t k, typename F::template Message<n>& m) const { all_.send(k, m); }
  void settle() { all_.settle(); }
  void release() { all_.release(); }

 private:
  Averaging<F, n> all_;
};

template <class F, int n>
  requires StepsSideBySide<F, n>
class Batch<F, n> : public AgentByAgent<F, n> {
 public:
  Batch(std::span<typename F::template State<n>> agents, int states) : all_(agents, states) {}
  template <class Locals>
  void join(const Locals& local) {
    all_.join(local);
  }
  template <class Locals>
  void start(const typename F::Gains& gains, const Locals& local) {
    all_.start(gains, local);
  }
  template <class Sample>
  BatchStep step(const Sample& sample) {
    return {all_.step(sample) ? BatchStep::everything : BatchStep::nothing, true};
  }
  template <class Locals, class Inboxes>
  bool fuse(const typename F::Gains& gains, const Locals& local, const Inboxes& inbox, Workers& workers) {
    all_.fuse(gains, local, inbox, workers);
    return true;
  }
  void part() { all_.part(); }
  void moved() { all_.look(); }

 private:
  SideBySide<F, n> all_;
};

}  // namespace garrison
