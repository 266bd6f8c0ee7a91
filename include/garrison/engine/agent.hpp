// SPDX-License-Identifier: Apache-2.0
// One agent on its own, driven by bytes: what a node, and everything that stands for one, holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "garrison/core/envelope.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/wire/letter.hpp"

namespace garrison {

struct AgentPart;
struct Change;

/// The same agent as inside the engine, with the same bits: `sense` once per sample, then per round `deliver`
/// what came and `fuse`. Nothing is allocated after construction but by `reset` and what returns vectors. It
/// holds its own part of the gains only.
///
/// Time is the driver's. An agent is at sample t, in round r of it, or between samples (round() == rounds()).
/// It starts, at the first sample less one, with the estimate zero.
/// Threads: one at a time.
class GARRISON_EXPORT Agent {
 public:
  /// What a call has to send, or why it was refused. No bytes and no refusal: the estimate is of no use (not
  /// finite, or beyond kHuge), so nothing is sent.
  struct Sent {
    Refusal refusal = Refusal::none;
    std::size_t bytes = 0;
  };
  /// Samples that an agent catches up on by itself.
  static constexpr std::int64_t kMostGap = 1000;

  virtual ~Agent() = default;
  virtual std::string_view family() const = 0;
  /// Fingerprint of the design that this is an agent of: messages of another are not for it.
  virtual std::uint64_t design() const = 0;
  /// Its plant and sensor, for drivers of plants with known inputs: the agent itself does not know them.
  virtual const AgentPart& part() const noexcept = 0;
  virtual int id() const = 0;
  virtual int agents() const = 0;  ///< of the whole network
  virtual int states() const = 0;
  virtual int outputs() const = 0;
  virtual int rounds() const = 0;
  /// Ids of those it hears, ascending.
  virtual std::span<const int> neighbours() const = 0;
  /// Of one body, whoever sends it.
  virtual std::size_t most_bytes() const = 0;
  virtual std::int64_t sample() const = 0;
  virtual int round() const = 0;

  /// Starts anew at sample t with the estimate x0 (n numbers). Unless t is the family's start nothing is
  /// known of how far x0 is off: no bound and no test, and in its next sample the agent says nothing and
  /// rejoins from what it hears, so that x0 does not spread (it stays where nothing is heard). Refused, with
  /// nothing changed: size, number (not finite, or beyond kHuge), late (before the start), early.
  virtual Refusal reset(const Vector& x0, std::int64_t t) = 0;
  Refusal reset(const Vector& x0) { return reset(x0, start()); }
  /// Where a run starts: the sample before the first.
  virtual std::int64_t start() const = 0;

  /// Sample t with its measurement (outputs() numbers, NaN = missing) to the first message. Samples that were
  /// missed in between, kMostGap at most, are made up for without measurements and messages, and nothing is
  /// claimed that they may have broken. Refused: order (rounds are left), late, early (too many were missed:
  /// reset or listen), size.
  virtual Sent sense(std::int64_t t, std::span<const double> y, std::span<std::byte> out) noexcept = 0;
  /// A body that a neighbour sent in this sample or the next, in any round not yet fused.
  virtual Refusal deliver(const Envelope& envelope, std::span<const std::byte> body) noexcept = 0;
  /// Whether the neighbour's message of the present round is here.
  virtual bool has(int sender) const noexcept = 0;
  /// Ends the present round with what was delivered; what it has to send is for the next one, or nobody.
  virtual Sent fuse(std::span<std::byte> out) noexcept = 0;

  /// Listens to sample t without taking part, to `join` with what was delivered for its first round: an
  /// estimate from the neighbours, after which the agent is at the end of sample t. Where nobody was heard it
  /// keeps its own, and says nothing until it hears somebody (`reset`); with `speak` it says it: for networks
  /// in which nobody else speaks, either. Refused: order.
  virtual Refusal listen(std::int64_t t) noexcept = 0;
  virtual Refusal join(bool speak = false) noexcept = 0;
  /// A gap lies behind this state, whatever the driver saw: nothing is claimed that it may have broken.
  virtual void uncover() noexcept = 0;

  virtual Report report() const noexcept = 0;
  virtual void estimate(std::span<double> out) const noexcept = 0;
  /// Control input applied until the next sample; NaN if the family has none.
  virtual double control() const noexcept = 0;
  virtual std::vector<int> accused() const = 0;
  /// Bounds on the error of each coordinate, states() numbers: with a certificate often far less than the
  /// bound of the report, which they are else.
  virtual void box(std::span<double> out) const noexcept = 0;
  /// Sources that its certificate has shown to be attacked, numbered in the order of their first measurement
  /// in the network; none without memory.
  virtual std::vector<int> proved() const = 0;
  /// How often the estimate was of no use and the agent rejoined.
  virtual std::int64_t resets() const noexcept = 0;

  /// Bytes of a snapshot, and the snapshot: between samples only (else 0). Loading refuses: order (rounds are
  /// left), size, foreign (another design, agent or version), damaged.
  virtual std::size_t snapshot_bytes() const noexcept = 0;
  virtual std::size_t save(std::span<std::byte> out) const noexcept = 0;
  virtual Refusal load(std::span<const std::byte> snapshot) noexcept = 0;

  /// What the body of a neighbour's message is made of, for people and for `Letter`.
  virtual std::vector<wire::FieldInfo> fields(int sender, std::int64_t t) = 0;

  /// Between samples: the plant of the next ones, until told again; matrices of this agent alone, null = the
  /// design's. It is no part of a snapshot; `reset` and `load` go back to the design's. No theorem of a
  /// family bounds anything then. Refused, with nothing changed: order, size, number, foreign (a family that
  /// is designed for one plant, or an agent with a certificate). It may allocate.
  virtual Refusal vary(const Change& plant) = 0;
};

/// What an agent needs besides its part of the gains: who it is, its plant, its sensor and whom it hears.
struct AgentPart {
  int id = 0;
  int agents = 0;
  Matrix A;
  Matrix C_transposed;  ///< n x outputs, so that rows of C follow each other in memory
  std::vector<int> neighbours;
  std::uint64_t design = 0;  ///< fingerprint of the whole design: snapshots and bodies of another are refused
  Matrix B = {};             ///< n x inputs; empty = no known inputs

  template <class V>
  void visit(V& v) {
    v.range("id", id, 0, agents > 0 ? agents - 1 : 65535);
    v.range("agents", agents, 1, INT32_MAX);
    v("A", A);
    v("C_transposed", C_transposed);
    v("neighbours", neighbours);
    v("design", design);
    v("B", B);
  }
};

/// As the functions of a family see it; borrows A and C.
inline Local local_of(const AgentPart& who) noexcept {
  return {who.id,
          who.agents,
          static_cast<int>(who.A.rows()),
          static_cast<int>(who.C_transposed.cols()),
          static_cast<int>(who.neighbours.size()),
          who.A.data(),
          who.C_transposed.data()};
}

}  // namespace garrison
