// SPDX-License-Identifier: Apache-2.0
// Who hears whom in a whole network, and which messages everybody may read in this round.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/fields.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/link.hpp"

namespace garrison {

/// Who hears whom: agent k hears slots[first[k]] .. slots[first[k + 1] - 1], in order of public id.
struct Wiring {
  const std::size_t* first;
  const std::uint32_t* slots;
};

/// What an agent hears in this round: messages[slots[j]] of agent senders[j], of so many that are due.
struct Heard {
  std::size_t begin;  ///< of the buffer that slots count from
  std::span<const std::uint32_t> slots;
  const int* senders;
  int due;
};

/// Places in one array of messages: a ring of buffers (one message per agent, in the engine's order) and
/// behind them a place per lying edge. On perfect links every agent reads its neighbours' slots of the
/// current buffer. Faults only rewrite slots: a lost or late message leaves its slot out, a forged one is
/// written behind the honest ones and only the victim points to it. What a message is, is not known here.
/// Threads: one at a time.
class GARRISON_EXPORT Routes {
 public:
  /// `order`: engine position -> public id; `rounds` per sample.
  Routes(const Network& network, std::span<const int> order, int states, int rounds);

  /// Starts a run over `link` (null = perfect). How many places it needs.
  std::size_t connect(Link* link);
  const Link* link() const { return link_; }
  /// First of the places for what liars send.
  std::size_t first_lie() const { return depth_ * order_.size(); }
  bool perfect() const { return link_ == nullptr || link_->perfect(); }
  Wiring wiring() const { return {first_.data(), slots_.data()}; }
  int id(std::size_t k) const { return order_[k]; }
  int agents() const { return static_cast<int>(order_.size()); }
  /// How many hear agent k.
  std::size_t listeners(std::size_t k) const { return listeners_[k]; }

  /// First place of the messages that are being written, which become current with `post`; of the current
  /// ones.
  std::size_t outgoing() const { return outgoing_; }
  std::size_t current() const { return current_; }
  void post() {
    current_ = outgoing_;
    outgoing_ = base(++posted_);
  }

  /// Whether everybody hears all that are due, as nothing can happen to a message. `plain`: as in
  /// Engine::rounds.
  bool as_wired(bool plain) { return as_wired_ = perfect() && plain; }
  /// Whether what agent k sent this round is finite and below kHuge.
  void deliverable(std::size_t k, bool is) { deliverable_[k] = is ? 1 : 0; }

  /// What a message holds, and which states it speaks of (none: the family sends whole states).
  struct Letter {
    FieldList fields;
    std::span<const int> entries;
  };
  /// The messages themselves, where somebody lies.
  /// Threads: one at a time.
  class Letters {
   public:
    /// Copies a message of `sender` for agent k; what is in the copy.
    virtual Letter copy(std::size_t from, std::size_t to, std::size_t k, int sender) const = 0;
    /// Whether the message is finite and below kHuge.
    virtual bool deliverable(std::size_t at) const = 0;

   protected:
    ~Letters() = default;
  };
  /// Prepares the inboxes of one round that are not as wired.
  void deliver(std::int64_t t, int round, const Letters& letters);

  Heard heard(std::size_t k) const {
    const std::size_t due = first_[k + 1] - first_[k];
    if (as_wired_)
      return {current_, std::span(slots_).subspan(first_[k], due), senders_.data() + first_[k],
              static_cast<int>(due)};
    return {0, std::span(delivered_).subspan(first_[k], received_[k]), delivered_from_.data() + first_[k],
            static_cast<int>(due)};
  }

 private:
  std::size_t base(std::uint64_t hop) const { return static_cast<std::size_t>(hop % depth_) * order_.size(); }
  /// A sample posts the messages of each round, and those after the last one.
  std::size_t posts_in(int samples) const {
    return static_cast<std::size_t>(samples) * static_cast<std::size_t>(rounds_ + 1);
  }
  /// Writes what a liar sends in place of the message in slot e to `to`; false when nothing is to be
  /// delivered.
  bool forge(const Hop& hop, std::size_t e, std::size_t to, std::size_t k, const Letters& letters,
             LinkCounters& counters);

  std::vector<int> order_;
  int states_;
  int rounds_;
  std::vector<std::size_t> first_;        // of each agent's slots, N+1
  std::vector<std::uint32_t> slots_;      // as wired: positions of the neighbours, by public id
  std::vector<int> senders_;              // their public ids
  std::vector<int> receivers_;            // of each slot
  std::vector<Fate> fates_;               // of what each slot carries this round
  std::vector<std::size_t> listeners_;    // of each agent
  std::vector<std::uint32_t> delivered_;  // as delivered this round: places of messages
  std::vector<int> delivered_from_;       // their senders
  std::vector<std::size_t> received_;     // how many of them
  std::vector<char> deliverable_;         // whether what an agent sent this round is finite and below kHuge
  std::size_t depth_ = 2;
  std::uint64_t posted_ = 0;
  std::size_t current_ = 0;
  std::size_t outgoing_ = 0;
  bool as_wired_ = true;
  Link* link_ = nullptr;
  bool lies_ = false;  // some agent lies in its messages
};

}  // namespace garrison
