// SPDX-License-Identifier: Apache-2.0
// The certificate with memory of one agent in a run (B): a bank of filters over all that it hears. Internal.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "garrison/certificate/memory/bank.hpp"
#include "garrison/certificate/online/doubts.hpp"
#include "garrison/certificate/online/plan.hpp"
#include "garrison/core/certificate_kind.hpp"
#include "garrison/core/change.hpp"
#include "garrison/wire/archive.hpp"

namespace garrison::certificate {

/// The state may be anything at its start, and after everything that ends it: a reset of the agent, a gap of
/// more than kMostAge samples, a refutation (the attacked have changed, noise is not what the model says, or
/// the rare event happened), numbers beyond all bounds. It then starts anew, from later measurements alone:
/// so bounds hold, whenever that was. Nothing is allocated after construction. Threads: one at a time.
class AgentBank {
 public:
  /// rows: in the plan, of each entry of what `take` is given.
  AgentBank(std::shared_ptr<const Plan> plan, std::span<const std::size_t> rows);

  /// Nothing is known at the end of sample t, nor was anything doubted.
  void reset(std::int64_t t) noexcept;
  /// A new sample has begun, of which nothing is known yet.
  void wait() noexcept { radius_ = kInfinity; }
  /// What has become known of sample t, later than the last one by any number; NaN = missing.
  void take(std::int64_t t, std::span<const double> y) noexcept;

  /// From the next sample on; change.rows: of the whole network, each a column here; null = the plan's. What
  /// the plan has as a row of zeros is not used.
  void vary(const Change& change) noexcept;
  /// What the last sample says alone: its box, which assumes less. Where no state is in both, this bank's
  /// region was wrong.
  void compare(std::span<const double> center, std::span<const double> box) noexcept;

  /// Bound on the error of an estimate (n numbers) of the last sample; kind `memory` where there is one.
  Bound bound(std::span<const double> estimate) const noexcept;
  /// Makes the bounds per coordinate in `out` smaller where this bank's are.
  void box(std::span<const double> estimate, std::span<double> out) const noexcept;
  /// Sources of the whole network that are shown to be attacked, ascending.
  std::span<const int> proved() const noexcept { return {proved_.data(), static_cast<std::size_t>(proofs_)}; }
  Doubts doubts() const noexcept;

  void visit(wire::Archive& archive);
  /// Whether what a snapshot held can be worked with.
  bool resume() noexcept;
  std::int64_t sample() const noexcept { return t_; }

 private:
  WindowLevels levels() const noexcept;
  void restart(std::int64_t t, bool everything) noexcept;
  void refute() noexcept;
  void learn(const WindowWitness& found) noexcept;

  std::shared_ptr<const Plan> plan_;
  std::vector<std::size_t> order_;  // entry of what `take` is given, of each output of the bank
  std::vector<int> source_;         // of the whole network, of each source of the bank
  std::vector<std::size_t> row_;    // in the plan, of each output of the bank
  Bank bank_;
  std::vector<BankSource> now_;  // its sources where rows are not the plan's
  bool varied_ = false;
  Change change_;  // A and Q of the sample where they are not the plan's
  Vector y_, nothing_;
  std::int64_t t_ = 0;
  std::int64_t tests_ = 0;  // samples that the bank has seen since it started
  double radius_ = kInfinity;
  Vector center_, box_;
  std::vector<int> proved_;  // the first proofs_ of them
  int proofs_ = 0;
  Doubts doubts_;
};

/// Null where the plan has no bank, or all sources that the agent hears may be attacked.
std::unique_ptr<AgentBank> make_agent_bank(const std::shared_ptr<const Plan>& plan,
                                           std::span<const std::size_t> rows);

}  // namespace garrison::certificate
