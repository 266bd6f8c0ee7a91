// SPDX-License-Identifier: Apache-2.0
// The agents of a whole network in groups, for the engine (runtime/together.hpp).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "garrison/filters/partial_sharing/disagreement.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"

namespace garrison {

/// Agents that follow each other in the engine's order share a group; one with fewer outputs than others has
/// rows of zeros. Their predictions are in one array: while links are perfect, neighbours read them there and
/// no message is written.
template <int n>
class PartialSharing::Together {
  using Group = partial_sharing::Group<n>;

 public:
  /// Gives every agent a lane. `local(k)`: what agent k of the engine's order is told.
  template <class Locals>
  void join(State<n>* states, std::size_t count, const Locals& local) {
    states_ = states;
    std::vector<int> most((count + Group::kLanes - 1) / Group::kLanes);  // outputs of an agent, by group
    for (auto& side : x_) side.resize(most.size() * Group::kLanes * n);
    for (std::size_t k = 0; k < count; ++k)
      most[k / Group::kLanes] = std::max(most[k / Group::kLanes], local(k).outputs);
    typename Group::Room room = allocate(most);
    for (std::size_t i = 0; i < most.size(); ++i) {
      const std::size_t first = i * Group::kLanes;
      Group& group = groups_.emplace_back(n, most[i], room, x_[0].data() + first * n);
      for (std::size_t piece = 0; piece < room.size(); ++piece)
        room[piece] += Group::size(n, most[i], typename Group::Piece(piece));
      group.agents = static_cast<int>(std::min<std::size_t>(Group::kLanes, count - first));
      for (int lane = 0; lane < group.agents; ++lane) {
        const std::size_t k = first + static_cast<std::size_t>(lane);
        states[k].group = std::shared_ptr<Group>(std::shared_ptr<void>(), &group);  // ours, not its own
        states[k].lane = lane;
        group.outputs[static_cast<std::size_t>(lane)] = local(k).outputs;
      }
    }
    twins_.resize(groups_.size());
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
    share_sensors();
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
    const int moved = g.selection.offset(t - 1);
    for (std::size_t k = 0; k < shares_.size(); ++k) now_[k] = partial_sharing::shifted<n>(shares_[k], moved);
    const double* const x = x_[side_].data();
    side_ = 1 - side_;
    each(common(any, g), workers, [&](Group& group, std::size_t first, std::size_t end, double* u) {
      const double* const far = x + ahead(first, kReach) * n;
      const double* const near = x_[side_].data() + ahead(first, 2 * Group::kLanes) * n;
      for (std::size_t k = first; k < end; ++k) {
        const std::size_t lane = k - first;
        const double* const measured = y(k);
        // Measurements are in order of public ids, and neighbours some hundred places away: the hardware's
        // own prefetcher sees neither of them coming.
        __builtin_prefetch(y(std::min(k + 2 * Group::kLanes, shares_.size() - 1)));
        __builtin_prefetch(far + lane * n);
        __builtin_prefetch(near + lane * n, 1);
        for (int r = 0; r < group.outputs[lane]; ++r)
          group.at(group.y, r, static_cast<int>(lane)) = measured[r];
      }
      const std::uint8_t* const shares = now_.data();
      run_widest_of<partial_sharing::Disagreement<n>, n>(x, shares, wiring, first, end, u);
    });
  }

  /// The same from inboxes, after every agent has sensed.
  template <class Inboxes, class Workers>
  void fuse(const Gains& g, const Local& any, const Inboxes& inbox, Message<n>* out,
            Workers& workers) noexcept {
    each(common(any, g), workers, [&](Group&, std::size_t first, std::size_t end, double* u) {
      for (std::size_t k = first; k < end; ++k, u += n) {
        disagreement<n>(states_[k], inbox(k), u);
        out[k].t = -1;  // nothing to say before the next sample
      }
    });
  }

 private:
  static constexpr std::size_t kReach = 1024;  // how far away neighbours are in large plane networks

  /// First agent of the group that is `places` further on, or of the last one.
  std::size_t ahead(std::size_t first, std::size_t places) const {
    return std::min(first + places, (groups_.size() - 1) * Group::kLanes);
  }

  /// `listen(group, first, end, u)` finds u of agents first..end-1; then they are updated.
  template <class Workers, class Listen>
  void each(const partial_sharing::Common& shared, Workers& workers, const Listen& listen) noexcept {
    double* const next = x_[side_].data();
    std::atomic<bool> plain{true};
    std::atomic<bool> rested{false};
    workers.split(static_cast<std::int64_t>(groups_.size()), [&](std::int64_t begin, std::int64_t end, int) {
      alignas(64) double u[Group::kLanes * n];
      alignas(64) double squares[Group::kLanes]{};
      bool came_to_rest = false;
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        Group& group = groups_[i];
        const std::size_t first = i * Group::kLanes;
        listen(group, first, first + static_cast<std::size_t>(group.agents), u);
        double* const predictions = next + first * n;
        const bool moving = group.moving();
        partial_sharing::update(shared, group, u, predictions, squares);
        came_to_rest = came_to_rest || (moving && !group.moving());
        group.x = predictions;
      }
      if (came_to_rest) rested = true;
      for (const double sum : squares)
        if (!(sum < partial_sharing::kPlain)) plain = false;
    });
    plain_ = plain;
    if (rested) share_gains();
  }

  /// Memory of all groups; where that of the first one is.
  typename Group::Room allocate(const std::vector<int>& most) {
    typename Group::Room room;
    for (std::size_t piece = 0; piece < room.size(); ++piece) {
      std::size_t size = 0;
      for (const int q : most) size += Group::size(n, q, typename Group::Piece(piece));
      room_[piece].resize(size);
      room[piece] = room_[piece].data();
    }
    return room;
  }

  /// Groups with the same sensors, lane by lane, read those of the first of them, and its gains once all are
  /// at rest: in a large network of few kinds of agents that is most of what frozen agents would read.
  void share_sensors() {
    std::map<std::vector<double>, Group*> known;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      Group& group = groups_[i];
      group.read_own_gains();
      std::vector<double> sensors(group.C, group.C + Group::size(n, group.q, Group::kSensors));
      twins_[i] = known.emplace(std::move(sensors), &group).first->second;
      group.read_sensors_of(*twins_[i]);
    }
    share_gains();
  }
  void share_gains() {
    for (std::size_t i = 0; i < groups_.size(); ++i) groups_[i].read_gains_of(*twins_[i]);
  }

  State<n>* states_ = nullptr;
  std::array<Aligned<double>, Group::kPieces> room_;  // of all groups, one after the other
  std::deque<Group> groups_;
  std::vector<Group*> twins_;         // first group with the same sensors
  std::array<Aligned<double>, 2> x_;  // predictions of this sample, and room for those of the next
  std::size_t side_ = 0;              // which is which
  std::vector<std::uint8_t> shares_;  // entries that each agent shares at k = 0
  std::vector<std::uint8_t> now_;     // and at this sample
  bool plain_ = true;
};

}  // namespace garrison
