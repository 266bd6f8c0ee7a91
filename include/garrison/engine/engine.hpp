// SPDX-License-Identifier: Apache-2.0
// All agents of a network in one process.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/batch/batch.hpp"
#include "garrison/engine/certified_network.hpp"
#include "garrison/engine/follows.hpp"
#include "garrison/engine/mailroom.hpp"
#include "garrison/engine/places.hpp"
#include "garrison/engine/plan/consensus.hpp"
#include "garrison/engine/runner.hpp"
#include "garrison/engine/workers.hpp"
#include "garrison/kernel/aligned.hpp"

namespace garrison {

/// Below this many agents per thread a round is too short to be worth waking another one.
inline constexpr int kAgentsPerThread = 20000;

/// Runs filter F for all agents. Agents are kept in an order in which neighbours are near (private; public
/// ids everywhere outside). Each agent writes only its own state and its inbox is in order of sender id, so
/// the result does not depend on the number of threads. Nothing is allocated after `reset`.
/// Threads: one at a time.
template <class F, int n>
class Engine final : public Runner {
  static_assert(Filter<F, n>);
  using State = typename F::template State<n>;
  using Message = typename F::template Message<n>;

 public:
  Engine(std::shared_ptr<const typename F::Gains> gains, const Model& model, const Network& network,
         int threads, std::unique_ptr<CertifiedNetwork> certified = nullptr)
      : gains_(std::move(gains)),
        plan_(network.offsets(), network.lists(), model.states()),
        places_(model, network, plan_.order()),
        mail_(network, plan_.order(), model.states(), F::rounds(*gains_)),
        workers_(std::min(threads, 1 + network.agents() / kAgentsPerThread)),
        states_(static_cast<std::size_t>(model.agents())),
        batch_(std::span<State>(states_), model.states()),
        certified_(std::move(certified)),
        accused_(model.agents()) {
    lost_.reserve(states_.size());
    batch_.join(locals());
  }

  void reset(const Matrix& x0, Link* link) override {
    mail_.connect(link);
    batch_.release();
    places_.constant();
    change_ = {};
    for (std::size_t k = 0; k < states_.size(); ++k) {
      const Vec<n> start = x0.col(places_.id(k));
      F::template init<n>(local(k), *gains_, start, states_[k], mail_.outgoing()[k]);
    }
    batch_.start(*gains_, locals());
    mail_.fill(certified_.get());
    bytes_ = mail_.bytes() * F::rounds(*gains_);
    variable_ = mail_.variable();
    samples_ = 0;
    overflows_ = resets_ = 0;
    if (certified_) certified_->reset(first_sample<F>() - 1);
  }

  void vary(const Change& change) override {
    if (change.A != nullptr || change.C != nullptr) places_.vary(change.A, change.C);
    change_ = change;
    if constexpr (follows<F, n>()) {
      batch_.part();
      for (std::size_t k = 0; k < states_.size(); ++k)
        F::template vary<n>(local(k), *gains_, change, places_.first_output(k), states_[k]);
      batch_.moved();
    }
  }
  void estimates(Matrix& out) const override {
    batch_.settle();
    for (std::size_t k = 0; k < states_.size(); ++k)
      out.col(places_.id(k)) = F::template estimate<n>(states_[k]);
  }
  void place(const Matrix& estimates) override {
    batch_.release();
    if constexpr (requires(State& s) { F::template averaged<n>(s); })
      for (std::size_t k = 0; k < states_.size(); ++k)
        std::copy_n(estimates.col(places_.id(k)).data(), estimates.rows(),
                    F::template averaged<n>(states_[k]));
  }

  void step(std::int64_t t, const double* y) override {
    if (certified_) certified_->begin(t, y, change_);
    if constexpr (requires { F::most_missing(*gains_); }) notice_missing(F::most_missing(*gains_), y);
    filter(t, y);
    if (certified_) certified_->finish(workers_);
  }

  void read(const Frame& f) const override {
    batch_.settle();
    const std::size_t N = states_.size();
    std::array<double, 32> signals{};
    for (std::size_t i = 0; i < N; ++i) {
      const std::size_t k = places_.of(static_cast<int>(i));
      const Vec<n>& x = F::template estimate<n>(states_[k]);
      const Report r = F::template report<n>(local(k), *gains_, states_[k]);
      if (f.estimate != nullptr)
        std::copy_n(x.data(), x.size(), f.estimate + i * static_cast<std::size_t>(x.size()));
      if (f.bound != nullptr) f.bound[i] = r.bound;
      if (f.bound_kind != nullptr) f.bound_kind[i] = static_cast<std::uint8_t>(r.kind);
      if (f.statistic != nullptr) f.statistic[i] = r.statistic;
      if (f.threshold != nullptr) f.threshold[i] = r.threshold;
      if (f.verdict != nullptr) f.verdict[i] = static_cast<std::uint8_t>(r.verdict);
      if (f.signals == nullptr) continue;
      F::template signals<n>(local(k), *gains_, states_[k], signals.data());
      for (std::size_t s = 0; s < F::signal_count; ++s) f.signals[s * N + i] = signals[s];
    }
    if (places_.varying())
      disclaim(f, N, static_cast<std::size_t>(F::template estimate<n>(states_.front()).size()));
    if (places_.varying() && !certified_) return;
    if (f.bound == nullptr || f.bound_kind == nullptr) return;
    if (!f.believed) std::fill_n(f.bound, N, kNaN);
    if (f.published != nullptr) std::copy_n(f.bound, N, f.published);
    if (!certified_ && f.box == nullptr) return name_bounds(f, N);
    for (std::size_t i = 0; i < N; ++i) {
      const Vec<n>& x = F::template estimate<n>(states_[places_.of(static_cast<int>(i))]);  // or a value
      certify(f, i, certified_ ? certified_->of(static_cast<int>(i)) : nullptr,
              {x.data(), static_cast<std::size_t>(x.size())});
    }
  }

  void expected(int agent, double* out) const override {
    batch_.settle();
    const std::size_t k = places_.of(agent);
    F::template expected<n>(local(k), *gains_, states_[k], out);
  }
  double alarm_level(int agent) const override {
    const std::size_t k = places_.of(agent);
    return F::template alarm_level<n>(local(k), *gains_, states_[k]);
  }
  void control(double* out) const override {
    batch_.settle();
    if constexpr (requires(const State& s) { F::template control<n>(s); })
      for (std::size_t k = 0; k < states_.size(); ++k)
        out[static_cast<std::size_t>(places_.id(k))] = F::template control<n>(states_[k]);
  }
  void detail(int agent, std::size_t which, std::vector<double>& out) const override {
    batch_.settle();
    const std::size_t k = places_.of(agent);
    if constexpr (requires(const State& s) { F::template detail<n>(local(k), *gains_, s, which, out); })
      F::template detail<n>(local(k), *gains_, states_[k], which, out);
  }
  const AgentSet& accused(int agent) const override {
    const State& s = states_[places_.of(agent)];
    if constexpr (requires { F::template accused_into<n>(s, accused_); }) {
      accused_.clear();
      F::template accused_into<n>(s, accused_);
      return accused_;
    } else {
      return *F::template accused<n>(s);
    }
  }
  std::span<const int> proved(int agent) const override {
    return certified_ ? certified_->of(agent)->proved() : std::span<const int>();
  }
  certificate::Doubts doubts(int agent) const override {
    return certified_ ? certified_->of(agent)->doubts() : certificate::Doubts();
  }
  std::int64_t overflows() const override { return overflows_; }
  std::int64_t resets() const override { return resets_; }
  unsigned refuted() const override {
    unsigned bits = 0;
    if constexpr (requires { F::template refuted<n>(states_[0]); })
      for (const State& s : states_) bits |= F::template refuted<n>(s);
    return bits;
  }
  std::int64_t bytes_per_step() const override {
    return (variable_ && samples_ > 0 ? (bytes_ + samples_ / 2) / samples_ : bytes_) +
           (certified_ ? certified_->bytes_per_step() : 0);
  }

 private:
  Local local(std::size_t k) const { return places_.local(k); }

  /// Who sees all measurements knows what no agent can: that too many are missing.
  void notice_missing(int most, const double* y) noexcept {
    if (!places_.miss_more_than(most, y)) return;
    for (State& s : states_) garrison::uncover<F, n>(*gains_, s);
  }

  auto locals() const {
    return [this](std::size_t k) { return local(k); };
  }
  auto measured(const double* y) const {
    return [this, y](std::size_t k) { return places_.measured(k, y); };
  }

  void filter(std::int64_t t, const double* y) {
    const bool plain = places_.measures_below(kPlain, y);
    if (plain && mail_.routes().perfect()) {
      const auto derive_from = [this](const auto& estimate) { derive(estimate); };
      const BatchStep taken = batch_.step(BatchSample{*gains_, plan_, mail_.routes().wiring(), workers_, t,
                                                      locals(), measured(y), derive_from});
      if (taken.done == BatchStep::everything) return;
      if (taken.done == BatchStep::sensed) {
        each([&](std::size_t k, Message* out) { batch_.send(k, out[k]); });
        return rounds(t, taken.plain);
      }
    }
    batch_.release();
    each([&, y = measured(y)](std::size_t k, Message* out) {
      F::template sense<n>(local(k), *gains_, states_[k], y(k), t, out[k]);
    });
    rounds(t, plain && all_plain());
  }

  /// Tells certificates which estimates are sent, estimate(k) by agent k: measurements may follow from them.
  template <class Estimate>
  void derive(const Estimate& estimate) {
    if constexpr (requires(const Message& m) { F::template sensed<n>(m); }) {
      if (!certified_ || !certified_->derives()) return;
      for (std::size_t k = 0; k < states_.size(); ++k) certified_->derive(places_.id(k), estimate(k));
    }
  }

  /// `plain`: every estimate and measurement is so small that every number of a message surely is below
  /// kHuge. Agents whose estimate cannot be worked with send nothing that is delivered, and rejoin after the
  /// last round.
  void rounds(std::int64_t t, bool plain) {
    derive([this](std::size_t k) { return sensed<F, n>(mail_.current(k)); });
    if (!plain) note_lost();
    const int L = F::rounds(*gains_);
    for (int round = 0; round < L; ++round) {
      count_bytes(round);
      CertifiedNetwork* const certified = plain && mail_.routes().perfect() ? nullptr : certified_.get();
      if (certified != nullptr) certified->say();
      mail_.collect(
          t, round, plain,
          [&](std::size_t k, int sender, Message& m) { shape<F, n>(local(k), *gains_, sender, t, m); },
          certified);
      if (certified != nullptr)
        certified->hear(workers_, mail_.routes(),
                        [this](std::size_t at) { return sensed<F, n>(mail_.at(at)); });
      const auto inbox = [this](std::size_t k) { return mail_.inbox(k); };
      if (batch_.fuse(*gains_, locals(), inbox, workers_))
        mail_.post();
      else
        each([&](std::size_t k, Message* out) {
          F::template fuse<n>(local(k), *gains_, states_[k], inbox(k), round, out[k]);
        });
    }
    if (!plain) rejoin(t);
  }

  void note_lost() {
    lost_.clear();
    for (std::size_t k = 0; k < states_.size(); ++k)
      if (!usable<n>(F::template estimate<n>(states_[k]))) lost_.push_back(k);
    overflows_ += lost_.empty() ? 0 : 1;
  }
  void rejoin(std::int64_t t) {
    const Inbox<Message> nobody(nullptr, {}, nullptr, 0);  // of a filter without rounds
    for (const std::size_t k : lost_) {
      const auto heard = F::rounds(*gains_) > 0 ? mail_.inbox(k) : nobody;
      F::template rejoin<n>(local(k), *gains_, heard, t, states_[k]);
    }
    resets_ += static_cast<std::int64_t>(lost_.size());
  }
  void count_bytes(int round) {
    if (!variable_) return;
    if (samples_ == 0) bytes_ = 0;
    bytes_ += mail_.bytes();
    samples_ += round == 0 ? 1 : 0;
  }

  /// Runs `action(k, outgoing)` for every agent k, then makes the outgoing messages the current ones.
  template <class Action>
  void each(const Action& action) {
    Message* out = mail_.outgoing();
    workers_.split(static_cast<std::int64_t>(states_.size()), [&](std::int64_t begin, std::int64_t end, int) {
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) action(k, out);
    });
    mail_.post();
  }

  bool all_plain() const {
    for (const State& s : states_)
      if (!usable<n>(F::template estimate<n>(s), kPlain)) return false;
    return true;
  }

  /// Gains and covariances are far below kHuge / kPlain.
  static constexpr double kPlain = 1e100;

  std::shared_ptr<const typename F::Gains> gains_;
  ConsensusPlan plan_;
  Places places_;
  Change change_;  // of the sample
  Mailroom<Message> mail_;
  Workers workers_;
  Aligned<State> states_;
  [[no_unique_address]] mutable Batch<F, n> batch_;
  std::unique_ptr<CertifiedNetwork> certified_;  // null: no certificate was asked for
  std::int64_t overflows_ = 0;
  std::vector<std::size_t> lost_;  // agents whose estimate is of no use at this sample
  std::int64_t resets_ = 0;
  std::int64_t bytes_ = 0;  // of a sample; where bodies vary: of all samples so far
  std::int64_t samples_ = 0;
  bool variable_ = false;
  mutable AgentSet accused_;  // of families that build it when asked
};

}  // namespace garrison
