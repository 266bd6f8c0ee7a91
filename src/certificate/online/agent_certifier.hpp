// SPDX-License-Identifier: Apache-2.0
// The one kind of certifier: witness of the sample, relay over rounds and time, bank. Internal.
#pragma once

#include "agent_bank.hpp"
#include "garrison/certificate/leverage_ball.hpp"
#include "garrison/certificate/online/certifier.hpp"
#include "garrison/certificate/online/plan.hpp"
#include "garrison/certificate/subsets.hpp"
#include "garrison/core/change.hpp"

namespace garrison::certificate {

class AgentCertifier final : public Certifier {
 public:
  AgentCertifier(std::shared_ptr<const Plan> plan, int id, std::span<const int> neighbours, int rounds);

  void reset(std::int64_t t) noexcept override;
  void begin(std::int64_t t, const double* y, const double* x) noexcept override;
  void say(int round, Evidence& out) const noexcept override;
  bool spares(int round, const Evidence& said) const noexcept override;
  void hear(int round, int sender, const Evidence& in) noexcept override;
  void hear_estimate(int sender, const double* x) noexcept override;
  bool derives(int sender) const noexcept override { return plan_->derives(sender); }
  void end_round(int round) noexcept override;
  void end_sample() noexcept override;
  Bound bound(std::span<const double> estimate) const noexcept override;
  void box(std::span<const double> estimate, std::span<double> out) const noexcept override;
  void shape_evidence(int sender, Evidence& out) const override;
  const Memory& memory() const noexcept { return memory_; }
  void visit(wire::Archive& archive) override;
  bool resume(std::int64_t t) noexcept override;
  std::span<const int> proved() const noexcept override;
  Doubts doubts() const noexcept override { return bank_ ? bank_->doubts() : Doubts(); }
  bool counts_family() const noexcept override { return plan_->family; }

  /// The last step of a sample in two, for drivers of whole networks: `witness`, or the one of an agent that
  /// knows the same.
  void witness() noexcept;
  void adopt(const AgentCertifier& other) noexcept;
  bool judges_in(int round) const { return flooded_ ? round == rounds_ - 1 : round == 0; }
  int known_rows() const { return known_; }
  bool knows_the_same(const AgentCertifier& other) const;

  /// For drivers of whole networks, who have derived what can be (Plan::tell).
  void begin(std::int64_t t, const double* y, Told told) noexcept;
  void hear_numbers(int sender, const double* y) noexcept;

  /// For drivers that do a sample without losses at once: `begin` with all measurements of the network that
  /// may arrive, by row of the plan. With `same`, which has begun: the relayed region is its.
  void begin_knowing(std::int64_t t, const double* all, const AgentCertifier* same) noexcept;
  void copy_relayed(const AgentCertifier& other) noexcept;
  /// As if it came in a message.
  void hear_relayed(const AgentCertifier& other) noexcept;
  bool relays_the_same(const AgentCertifier& other) const;
  bool found_the_same(const AgentCertifier& other) const;
  /// From the next sample on; change.rows: of the whole network, each a column here; null = the plan's.
  void vary(const Change& change) noexcept;
  /// Takes over all that lasts to the next sample.
  void copy(const AgentCertifier& other) noexcept { memory_ = other.memory_; }
  bool has_bank() const { return bank_ != nullptr; }
  bool flooded() const { return flooded_; }
  bool direct() const { return direct_; }

 private:
  std::size_t place(int agent) const;
  void move_to(std::int64_t t) noexcept;
  void learn(std::size_t at, double y) noexcept;
  void gather() noexcept;
  void interval_rule() noexcept;
  void keep(const Region& region) noexcept;
  void relay_own() noexcept;
  void remember() noexcept;
  void compare() noexcept;
  bool usable() const noexcept;
  bool eligible(int age, int fresh) const;
  void offer(const double* center, double radius, int age, int fresh) noexcept;
  bool goes_before(const double* center, double radius, int age) const;
  double aged(double radius, int age) const;

  std::shared_ptr<const Plan> plan_;
  int id_;
  int rounds_;
  bool flooded_;
  bool direct_;
  bool judged_ = true;            // the witness of this sample is there
  std::vector<int> agents_;       // whose rows may become known, ascending
  std::vector<std::size_t> at_;   // where each one's rows begin in y_, and their number
  std::vector<std::size_t> row_;  // in the plan, of each entry of y_
  std::vector<int> source_;       // numbered from 0 among the rows that may become known
  std::vector<double> y_;         // NaN = not known (yet)
  std::vector<double> own_;       // what is used for the own measurements
  std::vector<int> since_;        // first round in which each entry of y_ is passed on
  int region_since_ = 0;          // the same of the region
  Told told_ = Told::never_derived;
  int next_round_ = 0;  // in which what is heard now can be passed on
  int known_ = 0;
  bool one_row_each_ = true;          // no source has several rows
  Change now_;                        // what of the sample is not the plan's; rows: each a column
  bool gathered_ = false;             // rows_ are those of now_
  std::vector<char> present_, used_;  // of each entry of y_: it was known, and is a row, in rows_
  Rows rows_;
  LeverageWorkspace leverage_;
  SubsetsWorkspace subsets_;
  std::vector<double> ends_, y1_, width1_;  // of the interval rule
  Vector moved_;
  Memory memory_;
  std::unique_ptr<AgentBank> bank_;  // null = none
};

}  // namespace garrison::certificate
