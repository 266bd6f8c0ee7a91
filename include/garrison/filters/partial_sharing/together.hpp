// SPDX-License-Identifier: Apache-2.0
// The agents of a whole network in groups, for the engine (engine/batch/side_by_side.hpp).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "garrison/filters/partial_sharing/disagreement.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/partial_sharing/groups.hpp"

namespace garrison {

/// Agents that follow each other in the engine's order share a group; one with fewer outputs than others has
/// rows of zeros. Their predictions are in one array: while links are perfect, neighbours read them there and
/// no message is written.
template <int n>
class PartialSharing::Together {
  using Group = partial_sharing::Group<n>;
  using Outcome = partial_sharing::Outcome;

 public:
  /// Gives every agent a lane. `local(k)`: what agent k of the engine's order is told.
  template <class Locals>
  void join(State<n>* states, std::size_t count, const Locals& local) {
    states_ = states;
    std::vector<int> outputs(count);
    for (std::size_t k = 0; k < count; ++k) outputs[k] = local(k).outputs;
    for (auto& side : x_) side.resize((count + Group::kLanes - 1) / Group::kLanes * kGroupSize);
    groups_.arrange(outputs, [this](std::size_t i) { return next(i); });
    for (std::size_t k = 0; k < count; ++k) {
      Group* const ours = &groups_[k / Group::kLanes];
      states[k].group = std::shared_ptr<Group>(std::shared_ptr<void>(), ours);  // not the agent's own
      states[k].lane = static_cast<int>(k % Group::kLanes);
    }
    shares_.resize(count);
    now_.resize(count);
  }

  /// After `init` of all agents.
  template <class Locals>
  void start(const Gains& g, const Locals& local) {
    for (std::size_t k = 0; k < shares_.size(); ++k) {
      shares_[k] = 0;
      for (const int a : g.selection.entries(local(k).id)) shares_[k] |= static_cast<std::uint8_t>(1 << a);
    }
    groups_.share_sensors();
    double squares = 0.0;
    for (const double x : x_[side_]) squares += x * x;
    plain_ = squares < partial_sharing::kPlain;
  }

  /// Whether messages would carry nothing but what neighbours can read directly.
  bool agreed() const { return plain_; }

  /// One sample on perfect links. `y(k)`: measurements of agent k; `workers` split ranges of groups.
  template <class Measurements, class Wiring, class Workers>
  void step(const Gains& g, const Local& any, std::int64_t t, const Measurements& y, Wiring wiring,
            Workers& workers) noexcept {
    shift_shares(g.selection.offset(t - 1));
    const double* const x = x_[side_].data();
    side_ = 1 - side_;
    const partial_sharing::Common shared = common(any, g);
    each(workers, [&](std::size_t begin, std::size_t end, Outcome* outcome) {
      run_widest_of<Direct, n>(this, begin, end, &shared, x, wiring, &y, outcome);
    });
  }

  /// The same from inboxes, after every agent has sensed.
  template <class Inboxes, class Workers>
  void fuse(const Gains& g, const Local& any, const Inboxes& inbox, Workers& workers) noexcept {
    const partial_sharing::Common shared = common(any, g);
    each(workers, [&](std::size_t begin, std::size_t end, Outcome* outcome) {
      for (std::size_t i = begin; i < end; ++i) {
        Group& group = groups_[i];
        alignas(64) double u[kGroupSize];
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(group.agents); ++lane) {
          const std::size_t k = i * Group::kLanes + lane;
          disagreement<n>(states_[k], inbox(k), u + lane * n);
        }
        partial_sharing::update(shared, group, u, next(i), *outcome);
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
    GARRISON_INLINE static void run(Together* all, std::size_t begin, std::size_t end,
                                    const partial_sharing::Common* shared, const double* x, Wiring wiring,
                                    const Measurements* y, Outcome* outcome) noexcept {
      alignas(64) double u[kGroupSize];
      const std::uint8_t* const shares = all->now_.data();
      for (std::size_t i = begin; i < end; ++i) {
        Group* const group = &all->groups_[i];
        const std::size_t first = i * Group::kLanes;
        all->listen(*group, first, *y);
        partial_sharing::Disagreement<n>::template run<B>(x, shares, wiring, first,
                                                          first + static_cast<std::size_t>(group->agents), u);
        run_as_wide<partial_sharing::Update<n>, B>(shared, group, static_cast<const double*>(u), all->next(i),
                                                   outcome);
      }
    }
  };

  /// What everybody shares at a sample, `offset` entries further on than at k = 0.
  void shift_shares(int offset) noexcept {
    const std::uint8_t* const first = shares_.data();
    std::uint8_t* const now = now_.data();
    const std::size_t count = shares_.size();
#ifndef __clang__
#pragma GCC ivdep  // bytes might be anything, also each other
#endif
    for (std::size_t k = 0; k < count; ++k) now[k] = partial_sharing::shifted<n>(first[k], offset);
  }

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
    if (shares_.size() < kLarge) return;
    const double* const neighbours = x_[1 - side_].data() + ahead(first, kReach) * n;
    const double* const predictions = x_[side_].data() + soon * n;
    for (std::size_t lane = 0; lane < agents; ++lane) {
      __builtin_prefetch(neighbours + lane * n);
      __builtin_prefetch(predictions + lane * n, 1);
    }
  }

  /// First of as many agents as a group has, `places` further on or at the end.
  std::size_t ahead(std::size_t first, std::size_t places) const {
    const std::size_t count = shares_.size();
    return std::min(first + places, count - std::min<std::size_t>(count, Group::kLanes));
  }

  /// Where predictions of group i for the next sample go.
  double* next(std::size_t i) { return x_[side_].data() + i * kGroupSize; }

  /// `update(begin, end, outcome)` is one sample of groups begin..end-1.
  template <class Workers, class Step>
  void each(Workers& workers, const Step& update) noexcept {
    std::atomic<bool> plain{true};
    std::atomic<bool> rested{false};
    workers.split(static_cast<std::int64_t>(groups_.size()), [&](std::int64_t begin, std::int64_t end, int) {
      Outcome outcome;
      update(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), &outcome);
      if (outcome.rested) rested = true;
      for (const double sum : outcome.squares)
        if (!(sum < partial_sharing::kPlain)) plain = false;
    });
    plain_ = plain;
    if (rested) groups_.share_gains();
  }

  State<n>* states_ = nullptr;
  partial_sharing::Groups<n> groups_;
  std::array<Aligned<double>, 2> x_;  // predictions of this sample, and room for those of the next
  std::size_t side_ = 0;              // which is which
  std::vector<std::uint8_t> shares_;  // entries that each agent shares at k = 0
  std::vector<std::uint8_t> now_;     // and at this sample
  bool plain_ = true;
};

}  // namespace garrison
