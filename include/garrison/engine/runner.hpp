// SPDX-License-Identifier: Apache-2.0
// A whole network behind one interface: the library's only virtual seam on the way of a step.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/core/change.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/engine/link.hpp"

namespace garrison {

/// Where `Runner::read` writes; a null pointer skips that output. Agents are in order of public id.
struct Frame {
  double* estimate = nullptr;          ///< N x n, agent by agent
  double* bound = nullptr;             ///< N
  double* box = nullptr;               ///< N x n, agent by agent: the bound per coordinate
  double* published = nullptr;         ///< N: the family's own bound alone
  std::uint8_t* bound_kind = nullptr;  ///< N, values of CertificateKind
  double* statistic = nullptr;         ///< N
  double* threshold = nullptr;         ///< N
  std::uint8_t* verdict = nullptr;     ///< N, values of Verdict
  double* signals = nullptr;           ///< number of signals x N, signal by signal
  bool believed = true;  ///< false: agents may lie in their messages, so no bound of a family counts
};

/// No theorem of a family covers a plant that changes in time: there is no bound of any agent.
GARRISON_EXPORT void disclaim(const Frame& frame, std::size_t agents, std::size_t states);
/// Says where the bounds come from where there is nothing but the family's.
inline void name_bounds(const Frame& frame, std::size_t agents) noexcept {
  const double* const bound = frame.bound;
  std::uint8_t* const kinds = frame.bound_kind;
  for (std::size_t i = 0; i < agents; ++i)
    kinds[i] = static_cast<std::uint8_t>(
        certificate::least(bound[i], static_cast<CertificateKind>(kinds[i]), nullptr, {}).kind);
}
/// Says where the bound of agent i comes from, the family's or a better one, and what it is per coordinate;
/// `estimate` is the agent's, n numbers.
GARRISON_EXPORT void certify(const Frame& frame, std::size_t i, const certificate::Certifier* certifier,
                             std::span<const double> estimate);

/// All agents of one network, one filter, one trial.
/// Threads: one at a time.
class GARRISON_EXPORT Runner {
 public:
  virtual ~Runner() = default;
  /// Time 0: one initial estimate per agent, n x N. `link` (null = perfect) must outlive the run.
  /// @throws InvalidInput when an attack of the link changes what messages of this family do not hold
  virtual void reset(const Matrix& x0, Link* link) = 0;
  /// Tells the network, once before a sample, what differs from the model: A, C and covariances for families
  /// that can (Prepared::require_varying), the rest for their certificates. `reset` goes back to the model's.
  virtual void vary(const Change& change) = 0;
  /// Estimates of all agents, n x N in the order of public ids.
  virtual void estimates(Matrix& out) const = 0;
  /// Before a sample: puts others in their place; for the families that `vary` is for.
  virtual void place(const Matrix& estimates) = 0;
  /// One sample: every agent senses, then all rounds. `y` has Model::total_outputs() entries, NaN = missing.
  virtual void step(std::int64_t t, const double* y) = 0;
  virtual void read(const Frame& frame) const = 0;
  /// The measurement that `agent` predicts for the next sample, and the deviation it tolerates.
  virtual void expected(int agent, double* out) const = 0;
  virtual double alarm_level(int agent) const = 0;
  /// The control input of every agent until the next sample, N numbers; families without one write
  /// none.
  virtual void control(double* out) const = 0;
  /// Detail `which` of the family's detail_names, of one agent.
  virtual void detail(int agent, std::size_t which, std::vector<double>& out) const = 0;
  /// Agents that `agent` has accused.
  /// Valid until the next call.
  virtual const AgentSet& accused(int agent) const = 0;
  /// Sources that the certificate of `agent` has shown to be attacked (Agent::proved), ascending.
  virtual std::span<const int> proved(int agent) const = 0;
  /// What the data of `agent` say against its certificate with memory.
  virtual certificate::Doubts doubts(int agent) const = 0;
  /// Samples at which some estimate was not finite, or beyond kHuge (its messages are then withheld).
  virtual std::int64_t overflows() const = 0;
  /// Agents that rejoined because of that, summed over samples.
  virtual std::int64_t resets() const = 0;
  /// What the data of any agent have shown to be false so far: bits of the family's own (`refuted`), 0 =
  /// nothing.
  virtual unsigned refuted() const = 0;
  /// Bytes of the bodies of all messages of one sample, all rounds, when none is lost; known after `reset`.
  /// Where bodies vary in size (sets): the mean over the samples so far.
  virtual std::int64_t bytes_per_step() const = 0;
};

}  // namespace garrison
