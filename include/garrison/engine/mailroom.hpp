// SPDX-License-Identifier: Apache-2.0
// The messages of a whole network: buffers of the last rounds, and who may read which slot.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/inbox.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/link.hpp"

namespace garrison {

/// Who hears whom: agent k hears slots[first[k]] .. slots[first[k + 1] - 1], in order of public id.
struct Wiring {
  const std::size_t* first;
  const std::uint32_t* slots;
};

/// One array of messages: a ring of buffers (one message per agent, in the engine's order) and behind them a
/// place per lying edge. On perfect links every agent reads its neighbours' slots of the current buffer.
/// Faults only rewrite slots: a lost message leaves its slot out, a late one points into an older buffer, a
/// forged one is written behind the honest ones and only the victim points to it.
template <class Message>
class Mailroom {
 public:
  /// `order`: engine position -> public id. `states`: n of the plant.
  Mailroom(const Network& network, std::span<const int> order, int states)
      : order_(order.begin(), order.end()), states_(states) {
    std::vector<std::uint32_t> position(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k)
      position[static_cast<std::size_t>(order_[k])] = static_cast<std::uint32_t>(k);
    for (const int i : order_) {
      first_.push_back(slots_.size());
      for (const int j : network.neighbours(i)) slots_.push_back(position[static_cast<std::size_t>(j)]);
    }
    first_.push_back(slots_.size());
    delivered_.resize(slots_.size());
    received_.resize(order_.size());
    connect(nullptr);
  }

  /// Starts a run over `link` (null = perfect).
  void connect(Link* link) {
    link_ = link;
    depth_ = 2 + (link == nullptr ? 0 : static_cast<std::size_t>(link->memory()));
    std::size_t lies = 0;
    if (link != nullptr)
      for (const std::uint32_t sender : slots_) lies += link->lies(order_[sender]) ? 1 : 0;
    messages_.resize(depth_ * order_.size() + lies);
    posted_ = 0;
  }
  /// Copies the freshly initialised outgoing messages everywhere, so that later copies find their memory.
  void fill() {
    for (std::size_t k = order_.size(); k < messages_.size(); ++k)
      messages_[k] = messages_[k % order_.size()];
  }

  /// Numbers that all links carry in one round when no message is lost.
  std::int64_t numbers_per_round() {
    std::int64_t sum = 0;
    for (const std::uint32_t sender : slots_)
      sum += static_cast<std::int64_t>(messages_[sender].values().size());
    return sum;
  }

  Wiring wiring() const { return {first_.data(), slots_.data()}; }
  bool perfect() const { return link_ == nullptr || link_->perfect(); }
  /// Where agents write; becomes current with `post`.
  Message* outgoing() { return messages_.data() + base(posted_); }
  void post() { ++posted_; }

  /// Prepares the inboxes of one round from the current messages. `finite`: nobody has an estimate that is
  /// not.
  void collect(std::int64_t t, int round, bool finite) {
    as_wired_ = perfect() && finite;
    if (as_wired_) return;
    std::size_t forged = depth_ * order_.size();
    for (std::size_t k = 0; k < order_.size(); ++k) {
      received_[k] = 0;
      for (std::size_t e = first_[k]; e < first_[k + 1]; ++e)
        deliver({t, round, order_[slots_[e]], order_[k], states_}, slots_[e], k, forged);
    }
  }

  Inbox<Message> inbox(std::size_t k) const {
    if (as_wired_)
      return {messages_.data() + base(posted_ - 1),
              std::span(slots_).subspan(first_[k], first_[k + 1] - first_[k])};
    return {messages_.data(), std::span(delivered_).subspan(first_[k], received_[k])};
  }

 private:
  std::size_t base(std::uint64_t hop) const { return static_cast<std::size_t>(hop % depth_) * order_.size(); }

  /// Which states a message speaks of; families that send the whole state do not say.
  static std::span<const int> entries(const Message& message) {
    if constexpr (requires { message.entries(); })
      return message.entries();
    else
      return {};
  }

  void deliver(const Hop& hop, std::uint32_t sender, std::size_t receiver, std::size_t& forged) {
    LinkCounters nobody_counts;
    LinkCounters& counters = link_ == nullptr ? nobody_counts : link_->counters;
    const auto fate = link_ == nullptr ? Link::Fate::delivered : link_->fate(hop);
    std::uint64_t from = posted_ - 1;
    if (fate == Link::Fate::late) {
      const auto rounds_ago = static_cast<std::uint64_t>(link_->memory());
      if (from < rounds_ago) return void(++counters.lost);
      from -= rounds_ago;
    }
    if (fate == Link::Fate::lost) return void(++counters.lost);
    std::size_t slot = base(from) + sender;
    bool changed = false;
    if (link_ != nullptr && link_->lies(hop.sender)) {
      messages_[forged] = messages_[slot];
      slot = forged++;
      Hop told = hop;
      told.entries = entries(messages_[slot]);
      if (!link_->rewrite(told, messages_[slot].values(), changed)) return void(++counters.lost);
    }
    for (const double v : messages_[slot].values())
      if (!std::isfinite(v)) return void(++counters.refused);
    delivered_[first_[receiver] + received_[receiver]++] = static_cast<std::uint32_t>(slot);
    ++(changed ? counters.forged : fate == Link::Fate::late ? counters.late : counters.sent);
  }

  std::vector<int> order_;
  int states_;
  std::vector<std::size_t> first_;        // of each agent's slots, N+1
  std::vector<std::uint32_t> slots_;      // as wired: positions of the neighbours, by public id
  std::vector<std::uint32_t> delivered_;  // as delivered this round: indices into messages_
  std::vector<std::size_t> received_;     // how many of them
  std::vector<Message> messages_;
  std::size_t depth_ = 2;
  std::uint64_t posted_ = 0;
  bool as_wired_ = true;
  Link* link_ = nullptr;
};

}  // namespace garrison
