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
#include "garrison/engine/mailroom.hpp"
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
        model_(model),
        A_(model.A()),
        plan_(network.offsets(), network.lists(), model.states()),
        mail_(network, plan_.order(), model.states(), F::rounds(*gains_)),
        workers_(std::min(threads, 1 + network.agents() / kAgentsPerThread)),
        states_(static_cast<std::size_t>(model.agents())),
        batch_(std::span<State>(states_), model.states()),
        certified_(std::move(certified)),
        accused_(model.agents()) {
    position_.resize(states_.size());
    lost_.reserve(states_.size());
    for (const int i : plan_.order()) {
      position_[static_cast<std::size_t>(i)] = places_.size();
      places_.push_back({i, model_.outputs(i), network.degree(i), rows_.size()});
      first_output_.push_back(model_.offset(i));
      rows_.resize(rows_.size() + static_cast<std::size_t>(model_.C(i).size()));
    }
    sight(model_.stacked());
    batch_.join(locals());
  }

  void reset(const Matrix& x0, Link* link) override {
    mail_.connect(link);
    batch_.release();
    if (varying_) constant();
    for (std::size_t k = 0; k < states_.size(); ++k) {
      const Vec<n> start = x0.col(places_[k].id);
      F::template init<n>(local(k), *gains_, start, states_[k], mail_.outgoing()[k]);
    }
    batch_.start(*gains_, locals());
    mail_.fill();
    bytes_ = mail_.bytes() * F::rounds(*gains_);
    variable_ = mail_.variable();
    samples_ = 0;
    overflows_ = resets_ = 0;
    if (certified_) certified_->reset(first_sample<F>() - 1);
  }

  void vary(const Matrix* A, const Matrix* C) override {
    varying_ = true;
    if (A != nullptr) A_ = *A;
    if (C != nullptr) sight(*C);
  }

  void step(std::int64_t t, const double* y) override {
    if (certified_) certified_->begin(t, y);
    if constexpr (requires { F::most_missing(*gains_); }) notice_missing(F::most_missing(*gains_), y);
    filter(t, y);
    if (certified_) certified_->finish(workers_);
  }

  void read(const Frame& f) const override {
    batch_.settle();
    const std::size_t N = states_.size();
    std::array<double, 32> signals{};
    for (std::size_t i = 0; i < N; ++i) {
      const std::size_t k = position_[i];
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
    if (varying_ && f.bound != nullptr) disclaim(f);
    if (f.bound != nullptr && f.bound_kind != nullptr && !varying_) certify(f);
  }

  void expected(int agent, double* out) const override {
    batch_.settle();
    const std::size_t k = position_[static_cast<std::size_t>(agent)];
    F::template expected<n>(local(k), *gains_, states_[k], out);
  }
  double alarm_level(int agent) const override {
    const std::size_t k = position_[static_cast<std::size_t>(agent)];
    return F::template alarm_level<n>(local(k), *gains_, states_[k]);
  }
  void control(double* out) const override {
    batch_.settle();
    if constexpr (requires(const State& s) { F::template control<n>(s); })
      for (std::size_t k = 0; k < states_.size(); ++k)
        out[static_cast<std::size_t>(places_[k].id)] = F::template control<n>(states_[k]);
  }
  void detail(int agent, std::size_t which, std::vector<double>& out) const override {
    batch_.settle();
    const std::size_t k = position_[static_cast<std::size_t>(agent)];
    if constexpr (requires(const State& s) { F::template detail<n>(local(k), *gains_, s, which, out); })
      F::template detail<n>(local(k), *gains_, states_[k], which, out);
  }
  const AgentSet& accused(int agent) const override {
    const State& s = states_[position_[static_cast<std::size_t>(agent)]];
    if constexpr (requires { F::template accused_into<n>(s, accused_); }) {
      accused_.clear();
      F::template accused_into<n>(s, accused_);
      return accused_;
    } else {
      return *F::template accused<n>(s);
    }
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
    return (variable_ && samples_ > 0 ? bytes_ / samples_ : bytes_) +
           (certified_ ? certified_->bytes_per_step() : 0);
  }

 private:
  /// Where things of one agent are; a Local per agent would be twice as much to read at every step.
  struct Place {
    int id;
    int outputs;
    int degree;
    std::size_t first;  // in rows_
  };
  Local local(std::size_t k) const {
    const Place& p = places_[k];
    return {p.id, model_.agents(), model_.states(), p.outputs, p.degree, A_.data(), rows_.data() + p.first};
  }

  /// Writes the rows of all C_i, given on top of each other in the order of public ids. In place: batches
  /// keep pointers to them.
  void sight(const Matrix& C) {
    for (std::size_t k = 0; k < places_.size(); ++k) {
      double* row = rows_.data() + places_[k].first;
      for (int r = 0; r < places_[k].outputs; ++r)
        for (Eigen::Index c = 0; c < C.cols(); ++c) *row++ = C(first_output_[k] + r, c);
    }
  }
  void constant() {
    varying_ = false;
    A_ = model_.A();
    sight(model_.stacked());
  }

  /// Who sees all measurements knows what no agent can: that too many are missing.
  void notice_missing(int most, const double* y) noexcept {
    std::ptrdiff_t numbers = 0;
    for (int r = 0; r < model_.total_outputs(); ++r) numbers += y[r] != y[r] ? 1 : 0;
    if (numbers <= most) return;
    const auto any = [&](const Place& p, const double* own) {
      return std::any_of(own, own + p.outputs, [](double v) { return std::isnan(v); });
    };
    int sensors = 0;
    for (std::size_t k = 0; k < places_.size(); ++k) sensors += any(places_[k], y + first_output_[k]) ? 1 : 0;
    if (sensors <= most) return;
    for (State& s : states_) garrison::uncover<F, n>(*gains_, s);
  }

  auto locals() const {
    return [this](std::size_t k) { return local(k); };
  }
  auto measured(const double* y) const {
    return [this, y](std::size_t k) { return y + first_output_[k]; };
  }

  void filter(std::int64_t t, const double* y) {
    if (mail_.perfect()) {
      const BatchStep taken =
          batch_.step(BatchSample{*gains_, plan_, mail_.wiring(), workers_, t, locals(), measured(y)});
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
    rounds(t, all_usable());
  }

  /// `plain`: every estimate can be worked with. Agents whose cannot send nothing that is delivered, and
  /// rejoin after the last round.
  void rounds(std::int64_t t, bool plain) {
    if (!plain) note_lost();
    const int L = F::rounds(*gains_);
    for (int round = 0; round < L; ++round) {
      count_bytes(round);
      mail_.collect(t, round, plain, [&](std::size_t k, int sender, Message& m) {
        shape<F, n>(local(k), *gains_, sender, t, m);
      });
      if (certified_ && !(plain && mail_.perfect()))
        certified_->round(workers_, [this](int i, const auto& hear) { each_heard(i, hear); });
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
    ++overflows_;
    lost_.clear();
    for (std::size_t k = 0; k < states_.size(); ++k)
      if (!usable<n>(F::template estimate<n>(states_[k]))) lost_.push_back(k);
  }
  void rejoin(std::int64_t t) {
    const Inbox<Message> nobody(nullptr, {}, nullptr, 0);  // of a filter without rounds
    for (const std::size_t k : lost_) {
      const auto heard = F::rounds(*gains_) > 0 ? mail_.inbox(k) : nobody;
      F::template rejoin<n>(local(k), *gains_, heard, t, states_[k]);
    }
    resets_ += static_cast<std::int64_t>(lost_.size());
  }
  template <class Hear>
  void each_heard(int agent, const Hear& hear) const {
    const auto inbox = mail_.inbox(position_[static_cast<std::size_t>(agent)]);
    for (std::size_t j = 0; j < inbox.size(); ++j) hear(inbox.sender(j));
  }
  void count_bytes(int round) {
    if (!variable_) return;
    if (samples_ == 0) bytes_ = 0;
    bytes_ += mail_.bytes();
    samples_ += round == 0 ? 1 : 0;
  }

  /// No theorem of a family covers a plant that changes in time.
  void disclaim(const Frame& f) const {
    std::fill_n(f.bound, states_.size(), kNaN);
    if (f.published != nullptr) std::fill_n(f.published, states_.size(), kNaN);
    if (f.bound_kind != nullptr)
      std::fill_n(f.bound_kind, states_.size(), static_cast<std::uint8_t>(CertificateKind::varying));
  }

  /// Says where the bounds of the family come from, or puts better ones in their place.
  void certify(const Frame& f) const {
    const std::size_t N = states_.size();
    if (f.published != nullptr) std::copy_n(f.bound, N, f.published);
    const auto settle = [&f](std::size_t i, const certificate::Certifier* certifier,
                             std::span<const double> estimate) {
      const auto kind = static_cast<CertificateKind>(f.bound_kind[i]);
      const Bound bound = certificate::least(f.bound[i], kind, certifier, estimate);
      f.bound[i] = bound.value;
      f.bound_kind[i] = static_cast<std::uint8_t>(bound.kind);
    };
    if (!certified_) {
      for (std::size_t i = 0; i < N; ++i) settle(i, nullptr, {});
      return;
    }
    for (std::size_t i = 0; i < N; ++i) {
      const Vec<n>& x = F::template estimate<n>(states_[position_[i]]);  // of some families a value
      settle(i, certified_->of(static_cast<int>(i)), {x.data(), static_cast<std::size_t>(x.size())});
    }
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

  bool all_usable() const {
    for (const State& s : states_)
      if (!usable<n>(F::template estimate<n>(s))) return false;
    return true;
  }

  std::shared_ptr<const typename F::Gains> gains_;
  Model model_;
  Matrix A_;  // in force: the model's, or what `vary` said
  bool varying_ = false;
  ConsensusPlan plan_;
  Mailroom<Message> mail_;
  Workers workers_;
  Aligned<State> states_;
  [[no_unique_address]] mutable Batch<F, n> batch_;
  std::unique_ptr<CertifiedNetwork> certified_;  // null: no certificate was asked for
  std::vector<Place> places_;
  Aligned<double> rows_;           // of all C_i
  std::vector<int> first_output_;  // of each agent in y
  std::vector<std::size_t> position_;
  std::int64_t overflows_ = 0;
  std::vector<std::size_t> lost_;  // agents whose estimate is of no use at this sample
  std::int64_t resets_ = 0;
  std::int64_t bytes_ = 0;  // of a sample; where bodies vary: of all samples so far
  std::int64_t samples_ = 0;
  bool variable_ = false;
  mutable AgentSet accused_;  // of families that build it when asked
};

}  // namespace garrison
