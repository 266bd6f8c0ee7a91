// SPDX-License-Identifier: Apache-2.0
// Where an agent's messages wait for their round, whatever is in them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace garrison {

/// The places of a mailbox: two samples of all rounds, a place per neighbour, because messages of the next
/// sample may come early. Nothing is allocated after construction.
/// Threads: one at a time.
class AgentMail {
 public:
  /// `neighbours`: ascending; they outlive this.
  AgentMail(std::span<const int> neighbours, int rounds) : neighbours_(neighbours), rounds_(rounds) {
    arrived_.assign(2 * static_cast<std::size_t>(rounds) * neighbours.size(), kNever);
    slots_.reserve(neighbours.size());
    senders_.reserve(neighbours.size());
  }

  std::size_t places() const noexcept { return arrived_.size(); }
  /// Which neighbour an agent is; their number when it is none of them.
  std::size_t neighbour_of(int agent) const noexcept {
    const auto at = std::lower_bound(neighbours_.begin(), neighbours_.end(), agent);
    if (at != neighbours_.end() && *at != agent) return neighbours_.size();
    return static_cast<std::size_t>(at - neighbours_.begin());
  }
  std::size_t place(std::int64_t t, int round, std::size_t neighbour) const noexcept {
    const auto side = static_cast<std::size_t>(static_cast<std::uint64_t>(t) & 1U);
    return (side * static_cast<std::size_t>(rounds_) + static_cast<std::size_t>(round)) * neighbours_.size() +
           neighbour;
  }

  /// Whether a message of sample t is in this place.
  bool has(std::size_t place, std::int64_t t) const noexcept { return arrived_[place] == t; }
  void put(std::size_t place, std::int64_t t) noexcept { arrived_[place] = t; }
  void forget() noexcept { std::fill(arrived_.begin(), arrived_.end(), kNever); }

  /// Finds what has come for a round: `slots` and `senders` are of it until the next call.
  void open(std::int64_t t, int round) noexcept {
    close();
    for (std::size_t k = 0; k < neighbours_.size(); ++k) {
      const std::size_t at = place(t, round, k);
      if (arrived_[at] != t) continue;
      slots_.push_back(static_cast<std::uint32_t>(at));
      senders_.push_back(neighbours_[k]);
    }
  }
  /// Nothing has come.
  void close() noexcept {
    slots_.clear();
    senders_.clear();
  }
  std::span<const std::uint32_t> slots() const noexcept { return slots_; }
  const std::vector<int>& senders() const noexcept { return senders_; }

 private:
  static constexpr std::int64_t kNever = INT64_MIN;

  std::span<const int> neighbours_;
  int rounds_;
  std::vector<std::int64_t> arrived_;  // the sample that the message in each place is of
  std::vector<std::uint32_t> slots_;   // of the round that is being fused
  std::vector<int> senders_;
};

}  // namespace garrison
