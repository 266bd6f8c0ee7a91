// SPDX-License-Identifier: Apache-2.0
// Families that step several agents of a network at once (docs/adr/0006).
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/filter.hpp"
#include "garrison/engine/batch/groups.hpp"
#include "garrison/engine/workers.hpp"
#include "garrison/kernel/aligned.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison {

/// A family whose agents can be stepped side by side has an F::SideBySide<n> with
/// - `Group`: the numbers of kLanes agents, one lane for each (its pieces of memory: see Groups);
/// - `place(state, group, lane)`, once, before `init`: where an agent's numbers are from then on;
/// - `start(gains, count, local)` after every agent's `init`, `begin(gains, t)` before every sample;
/// - `hear<B>(x, wiring, begin, end, u)`: what agents begin..end-1 make of the predictions x of the whole
///   network, agent by agent; `hear(state, inbox, u)`: the same of one agent from its inbox;
/// - `Update::run<B>(common, group, u, next, outcome)`: one sample of a group, predictions for the next one
/// into
///   `next`; `update` the same for any instruction set; `common(local, gains)`: what all agents have in
///   common;
/// - `Outcome`: `plain()`, whether all predictions can be read without a message; `rested`, whether gains of
///   some group have become constant. `plain(sum of squares)` says the first of the start.
template <class F, int n>
concept StepsSideBySide = n != Dynamic && requires { typename F::template SideBySide<n>; };

/// Agents that follow each other in the engine's order share a group; one with fewer outputs than others has
/// rows of zeros. Their predictions are in one array: while links are perfect, neighbours read them there and
/// no message is written. Bits are those of agents on their own, for any number of threads.
/// Threads: one at a time.
template <class F, int n>
class SideBySide {
  using State = typename F::template State<n>;
  using Lanes = typename F::template SideBySide<n>;
  using Group = typename Lanes::Group;
  using Outcome = typename Lanes::Outcome;
  using Common = typename Lanes::Common;

 public:
  SideBySide(std::span<State> states, int) : states_(states) {}

  /// Gives every agent a lane. `local(k)`: what agent k of the engine's order is told.
  template <class Locals>
  void join(const Locals& local) {
    const std::size_t count = states_.size();
    std::vector<int> outputs(count);
    for (std::size_t k = 0; k < count; ++k) outputs[k] = local(k).outputs;
    for (auto& side : x_) side.resize((count + Group::kLanes - 1) / Group::kLanes * kGroupSize);
    groups_.arrange(outputs, [this](std::size_t i) { return next(i); });
    for (std::size_t k = 0; k < count; ++k)
      Lanes::place(states_[k], &groups_[k / Group::kLanes], static_cast<int>(k % Group::kLanes));
  }

  /// After `init` of all agents.
  template <class Locals>
  void start(const typename F::Gains& g, const Locals& local) {
    lanes_.start(g, states_.size(), local);
    groups_.share_sensors();
    look();
  }
  /// Sensors and gains of agents may differ from now on.
  void part() { groups_.part(); }
  /// After predictions were made outside of a step.
  void look() {
    double squares = 0.0;
    for (const double x : x_[side_]) squares += x * x;
    plain_ = Outcome::plain(squares);
  }

  /// One sample on perfect links, where messages would carry nothing but what neighbours can read directly;
  /// else nothing is done. `y(k)`: measurements of agent k.
  template <class Sample>
  bool step(const Sample& s) {
    if (!plain_) return false;
    lanes_.begin(s.gains, s.t);
    const double* const x = x_[side_].data();
    side_ = 1 - side_;
    const Common shared = Lanes::common(s.local(0), s.gains);
    each(s.workers, [&](std::size_t begin, std::size_t end, Outcome* outcome) {
      run_widest_of<Direct, n>(this, begin, end, &shared, x, s.wiring, &s.y, outcome);
    });
    return true;
  }

  /// The same from inboxes, after every agent has sensed.
  template <class Locals, class Inboxes>
  void fuse(const typename F::Gains& g, const Locals& local, const Inboxes& inbox,
            Workers& workers) noexcept {
    const Common shared = Lanes::common(local(0), g);
    each(workers, [&](std::size_t begin, std::size_t end, Outcome* outcome) {
      for (std::size_t i = begin; i < end; ++i) {
        Group& group = groups_[i];
        alignas(64) double u[kGroupSize];
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(group.agents); ++lane) {
          const std::size_t k = i * Group::kLanes + lane;
          Lanes::hear(states_[k], inbox(k), u + lane * n);
        }
        Lanes::update(shared, group, u, next(i), *outcome);
      }
    });
  }

 private:
  static constexpr std::size_t kLarge = 8192;  // agents that do not fit a second-level cache
  static constexpr std::size_t kReach = 1024;  // how far away neighbours are in large plane networks
  static constexpr std::size_t kGroupSize = std::size_t{Group::kLanes} * n;

  /// One sample of groups begin..end-1 without messages.
  struct Direct {
    template <int B, class Wiring, class Measurements>
    GARRISON_INLINE static void run(SideBySide* all, std::size_t begin, std::size_t end, const Common* shared,
                                    const double* x, Wiring wiring, const Measurements* y,
                                    Outcome* outcome) noexcept {
      alignas(64) double u[kGroupSize];
      for (std::size_t i = begin; i < end; ++i) {
        Group* const group = &all->groups_[i];
        const std::size_t first = i * Group::kLanes;
        all->listen(*group, first, *y);
        all->lanes_.template hear<B>(x, wiring, first, first + static_cast<std::size_t>(group->agents), u);
        run_as_wide<typename Lanes::Update, B>(shared, group, static_cast<const double*>(u), all->next(i),
                                               outcome);
      }
    }
  };

  /// Measurements of the group whose first agent is `first`.
  template <class Measurements>
  GARRISON_INLINE void listen(Group& group, std::size_t first, const Measurements& y) {
    fetch(first, static_cast<std::size_t>(group.agents), y);
    const auto take = [&](std::size_t lane, int r) GARRISON_INLINED {
      group.at(group.y, r, static_cast<int>(lane)) = y(first + lane)[r];
    };
    if (group.even)
      for (int r = 0; r < group.q; ++r)
        for (std::size_t lane = 0; lane < Group::kLanes; ++lane) take(lane, r);
    else
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(group.agents); ++lane)
        for (int r = 0; r < group.outputs[lane]; ++r) take(lane, r);
  }

  /// Starts to fetch what later groups of `agents` need. Measurements are in order of public ids, and
  /// neighbours in a large network some hundred places away: the hardware's own prefetcher sees neither of
  /// them coming.
  template <class Measurements>
  GARRISON_INLINE void fetch(std::size_t first, std::size_t agents, const Measurements& y) const {
    const std::size_t soon = ahead(first, 2 * Group::kLanes);
    for (std::size_t lane = 0; lane < agents; ++lane) __builtin_prefetch(y(soon + lane));
    if (states_.size() < kLarge) return;
    const double* const neighbours = x_[1 - side_].data() + ahead(first, kReach) * n;
    const double* const predictions = x_[side_].data() + soon * n;
    for (std::size_t lane = 0; lane < agents; ++lane) {
      __builtin_prefetch(neighbours + lane * n);
      __builtin_prefetch(predictions + lane * n, 1);
    }
  }

  /// First of as many agents as a group has, `places` further on or at the end.
  std::size_t ahead(std::size_t first, std::size_t places) const {
    const std::size_t count = states_.size();
    return std::min(first + places, count - std::min<std::size_t>(count, Group::kLanes));
  }

  /// Where predictions of group i for the next sample go.
  double* next(std::size_t i) { return x_[side_].data() + i * kGroupSize; }

  /// `update(begin, end, outcome)` is one sample of groups begin..end-1.
  template <class Step>
  void each(Workers& workers, const Step& update) noexcept {
    std::atomic<bool> plain{true};
    std::atomic<bool> rested{false};
    workers.split(static_cast<std::int64_t>(groups_.size()), [&](std::int64_t begin, std::int64_t end, int) {
      Outcome outcome;
      update(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), &outcome);
      if (outcome.rested) rested = true;
      if (!outcome.plain()) plain = false;
    });
    plain_ = plain;
    if (rested) groups_.share_gains();
  }

  std::span<State> states_;
  Lanes lanes_;
  Groups<Group, n> groups_;
  std::array<Aligned<double>, 2> x_;  // predictions of this sample, and room for those of the next
  std::size_t side_ = 0;              // which is which
  bool plain_ = true;
};

}  // namespace garrison
