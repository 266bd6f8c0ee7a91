// SPDX-License-Identifier: Apache-2.0
// All groups of a network and their memory.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "garrison/kernel/aligned.hpp"

namespace garrison {

/// What is read together is one array for all groups (Group::Piece), in the order in which they are stepped.
/// Threads: one at a time.
template <class Group, int n>
class Groups {
 public:
  /// Once, for agents with so many outputs each. Those of a group have their predictions one after the other
  /// from `predictions(i)` on, with room for kSize.
  template <class Predictions>
  void arrange(const std::vector<int>& outputs, const Predictions& predictions) {
    const std::size_t count = (outputs.size() + kSize - 1) / kSize;
    const auto first = [&](std::size_t i) {
      return outputs.begin() + static_cast<std::ptrdiff_t>(i * kSize);
    };
    const auto agents = [&](std::size_t i) { return std::min(kSize, outputs.size() - i * kSize); };
    std::vector<int> most(count);
    for (std::size_t i = 0; i < count; ++i)
      most[i] = *std::max_element(first(i), first(i) + static_cast<std::ptrdiff_t>(agents(i)));
    typename Group::Room room = allocate(most);
    groups_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      Group& group = groups_.emplace_back(n, most[i], room, predictions(i));
      for (std::size_t piece = 0; piece < room.size(); ++piece)
        room[piece] += Group::size(n, most[i], typename Group::Piece(piece));
      group.agents = static_cast<int>(agents(i));
      std::copy_n(first(i), agents(i), group.outputs.begin());
      group.even = agents(i) == kSize && std::all_of(group.outputs.begin(), group.outputs.end(),
                                                     [&](int q) { return q == group.q; });
    }
    twins_.resize(count);
  }

  std::size_t size() const { return groups_.size(); }
  Group& operator[](std::size_t i) { return groups_[i]; }

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
  /// Every group reads its own sensors and gains, which were those that it shared.
  void part() {
    for (Group& group : groups_) {
      group.read_own_sensors();
      group.read_own_gains();
    }
  }
  void share_gains() {
    for (std::size_t i = 0; i < groups_.size(); ++i) groups_[i].read_gains_of(*twins_[i]);
  }

 private:
  static constexpr std::size_t kSize = std::size_t{Group::kLanes};

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

  std::array<Aligned<double>, Group::kPieces> room_;
  std::vector<Group> groups_;
  std::vector<Group*> twins_;  // first group with the same sensors
};

}  // namespace garrison
