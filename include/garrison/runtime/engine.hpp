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
#include "garrison/runtime/consensus.hpp"
#include "garrison/runtime/mailroom.hpp"
#include "garrison/runtime/runner.hpp"
#include "garrison/runtime/workers.hpp"

namespace garrison {

/// A family whose rounds only average estimates as long as all agents carry the same side information:
/// the engine then averages the whole network at once, with the same bits.
template <class F, int n>
concept Averages = requires(const typename F::Gains& g, typename F::template State<n>& s) {
  F::averaging(g).alpha;
  { F::template averaged<n>(s) } -> std::same_as<double*>;
  { F::template same_side_information<n>(s, s) } -> std::same_as<bool>;
};

/// Below this many agents per thread a round is too short to be worth waking another one.
inline constexpr int kAgentsPerThread = 20000;

/// Runs filter F for all agents. Agents are kept in an order in which neighbours are near (private; public
/// ids everywhere outside). Each agent writes only its own state and its inbox is in order of sender id, so
/// the result does not depend on the number of threads. Nothing is allocated after `reset`.
template <class F, int n>
class Engine final : public Runner {
  static_assert(Filter<F, n>);
  using State = typename F::template State<n>;
  using Message = typename F::template Message<n>;

 public:
  Engine(std::shared_ptr<const typename F::Gains> gains, const Model& model, const Network& network,
         int threads)
      : gains_(std::move(gains)),
        model_(model),
        plan_(network.offsets(), network.lists()),
        mail_(network, plan_.order()),
        workers_(std::min(threads, 1 + network.agents() / kAgentsPerThread)),
        states_(static_cast<std::size_t>(model.agents())),
        average_(states_.size() * static_cast<std::size_t>(model.states())),
        scratch_(average_.size()) {
    const int nn = model_.states();
    position_.resize(states_.size());
    rows_.reserve(static_cast<std::size_t>(model_.total_outputs()) * static_cast<std::size_t>(nn));
    for (const int i : plan_.order()) {
      position_[static_cast<std::size_t>(i)] = locals_.size();
      const double* own_rows = rows_.data() + rows_.size();
      const Matrix& C = model_.C(i);
      for (Eigen::Index r = 0; r < C.rows(); ++r)
        for (int c = 0; c < nn; ++c) rows_.push_back(C(r, c));
      locals_.push_back(
          {i, model_.agents(), nn, model_.outputs(i), network.degree(i), model_.A().data(), own_rows});
    }
  }

  void reset(const Matrix& x0, Link* link) override {
    mail_.connect(link);
    for (std::size_t k = 0; k < states_.size(); ++k) {
      const Vec<n> start = x0.col(locals_[k].id);
      F::template init<n>(locals_[k], *gains_, start, states_[k], mail_.outgoing()[k]);
    }
    mail_.fill();
    overflows_ = 0;
  }

  void step(std::int64_t t, const double* y) override {
    each([&](std::size_t k, Message* out) {
      F::template sense<n>(locals_[k], *gains_, states_[k], y + model_.offset(locals_[k].id), t, out[k]);
    });
    const bool finite = all_finite();
    if (!finite) ++overflows_;
    const int rounds = F::rounds(*gains_);
    if constexpr (Averages<F, n>)
      if (finite && mail_.perfect() && average_at_once(rounds)) return;
    for (int round = 0; round < rounds; ++round) {
      mail_.collect(t, round, finite);
      each([&](std::size_t k, Message* out) {
        F::template fuse<n>(locals_[k], *gains_, states_[k], mail_.inbox(k), round, out[k]);
      });
    }
  }

  void read(const Frame& f) const override {
    const std::size_t N = states_.size();
    std::array<double, 32> signals{};
    for (std::size_t k = 0; k < N; ++k) {
      const auto i = static_cast<std::size_t>(locals_[k].id);
      const Vec<n>& x = F::template estimate<n>(states_[k]);
      const Report r = F::template report<n>(locals_[k], *gains_, states_[k]);
      if (f.estimate != nullptr)
        std::copy_n(x.data(), x.size(), f.estimate + i * static_cast<std::size_t>(x.size()));
      if (f.bound != nullptr) f.bound[i] = r.bound;
      if (f.statistic != nullptr) f.statistic[i] = r.statistic;
      if (f.threshold != nullptr) f.threshold[i] = r.threshold;
      if (f.verdict != nullptr) f.verdict[i] = static_cast<std::uint8_t>(r.verdict);
      if (f.signals == nullptr) continue;
      F::template signals<n>(locals_[k], *gains_, states_[k], signals.data());
      for (std::size_t s = 0; s < F::signal_count; ++s) f.signals[s * N + i] = signals[s];
    }
  }

  void expected(int agent, double* out) const override {
    const std::size_t k = position_[static_cast<std::size_t>(agent)];
    F::template expected<n>(locals_[k], *gains_, states_[k], out);
  }
  double alarm_level(int agent) const override {
    const std::size_t k = position_[static_cast<std::size_t>(agent)];
    return F::template alarm_level<n>(locals_[k], *gains_, states_[k]);
  }
  const AgentSet& accused(int agent) const override {
    return *F::template accused<n>(states_[position_[static_cast<std::size_t>(agent)]]);
  }
  std::int64_t overflows() const override { return overflows_; }

 private:
  /// Runs `action(k, outgoing)` for every agent k, then makes the outgoing messages the current ones.
  template <class Action>
  void each(const Action& action) {
    Message* out = mail_.outgoing();
    workers_.split(static_cast<std::int64_t>(states_.size()), [&](std::int64_t begin, std::int64_t end, int) {
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) action(k, out);
    });
    mail_.post();
  }

  bool all_finite() const {
    for (const State& s : states_)
      if (!F::template estimate<n>(s).allFinite()) return false;
    return true;
  }

  bool average_at_once(int rounds) {
    for (const State& s : states_)
      if (!F::template same_side_information<n>(states_.front(), s)) return false;
    const auto nn = static_cast<std::size_t>(model_.states());
    for (std::size_t k = 0; k < states_.size(); ++k)
      std::copy_n(F::template averaged<n>(states_[k]), nn, average_.data() + k * nn);
    const auto [alpha, omega] = F::averaging(*gains_);
    plan_.run(average_.data(), scratch_.data(), model_.states(), alpha, omega, rounds, &workers_);
    for (std::size_t k = 0; k < states_.size(); ++k)
      std::copy_n(average_.data() + k * nn, nn, F::template averaged<n>(states_[k]));
    return true;
  }

  std::shared_ptr<const typename F::Gains> gains_;
  Model model_;
  ConsensusPlan plan_;
  Mailroom<Message> mail_;
  Workers workers_;
  std::vector<State> states_;
  std::vector<Local> locals_;
  std::vector<double> rows_;
  std::vector<std::size_t> position_;
  std::vector<double> average_;
  std::vector<double> scratch_;
  std::int64_t overflows_ = 0;
};

}  // namespace garrison
