// SPDX-License-Identifier: Apache-2.0
// The messages of a whole network: buffers of the last rounds, and who may read which slot.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/fields.hpp"
#include "garrison/core/inbox.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/link.hpp"
#include "garrison/wire/message.hpp"

namespace garrison {

/// Who hears whom: agent k hears slots[first[k]] .. slots[first[k + 1] - 1], in order of public id.
struct Wiring {
  const std::size_t* first;
  const std::uint32_t* slots;
};

/// One array of messages: a ring of buffers (one message per agent, in the engine's order) and behind them a
/// place per lying edge. On perfect links every agent reads its neighbours' slots of the current buffer.
/// Faults only rewrite slots: a lost or late message leaves its slot out, a forged one is written behind the
/// honest ones and only the victim points to it.
/// Threads: one at a time.
template <class Message>
class Mailroom {
 public:
  /// `order`: engine position -> public id. `states`: n of the plant; `rounds` per sample.
  Mailroom(const Network& network, std::span<const int> order, int states, int rounds)
      : order_(order.begin(), order.end()), states_(states), rounds_(rounds) {
    std::vector<std::uint32_t> position(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k)
      position[static_cast<std::size_t>(order_[k])] = static_cast<std::uint32_t>(k);
    for (const int i : order_) {
      first_.push_back(slots_.size());
      for (const int j : network.neighbours(i)) {
        slots_.push_back(position[static_cast<std::size_t>(j)]);
        senders_.push_back(j);
        receivers_.push_back(i);
      }
    }
    first_.push_back(slots_.size());
    listeners_.resize(order_.size());
    for (const std::uint32_t sender : slots_) ++listeners_[sender];
    delivered_.resize(slots_.size());
    delivered_from_.resize(slots_.size());
    received_.resize(order_.size());
    deliverable_.resize(order_.size());
    connect(nullptr);
  }

  /// Starts a run over `link` (null = perfect).
  void connect(Link* link) {
    link_ = link;
    depth_ = 2 + (link == nullptr ? 0 : posts_in(link->memory()));
    std::size_t lies = 0;
    if (link != nullptr)
      for (const int sender : senders_) lies += link->lies(sender) ? 1 : 0;
    lies_ = lies > 0;
    fates_.assign(senders_.size(), Fate::delivered);
    messages_.resize(depth_ * order_.size() + lies);
    posted_ = 0;
  }
  /// Copies the freshly initialised outgoing messages everywhere, so that later copies find their memory.
  void fill() {
    for (std::size_t k = order_.size(); k < messages_.size(); ++k)
      messages_[k] = messages_[k % order_.size()];
  }

  /// Bytes of the bodies that all links carry in this round when no message is lost.
  std::int64_t bytes() const {
    const Message* const current = messages_.data() + base(posted_ == 0 ? 0 : posted_ - 1);
    std::size_t sum = 0;
    for (std::size_t k = 0; k < order_.size(); ++k) sum += listeners_[k] * size(current[k]);
    return static_cast<std::int64_t>(sum);
  }
  /// Whether bodies grow and shrink with what they hold.
  bool variable() const {
    return std::any_of(messages_.begin(), messages_.end(),
                       [&](const Message& m) { return wire::most_bytes(m, agents()) != size(m); });
  }

  Wiring wiring() const { return {first_.data(), slots_.data()}; }
  bool perfect() const { return link_ == nullptr || link_->perfect(); }
  /// Where agents write; becomes current with `post`.
  Message* outgoing() { return messages_.data() + base(posted_); }
  void post() { ++posted_; }

  /// Prepares the inboxes of one round from the current messages. `plain`: every estimate is finite and below
  /// kHuge. `shape(receiver, sender, message)` derives what a message does not carry.
  template <class Shape>
  void collect(std::int64_t t, int round, bool plain, const Shape& shape) {
    as_wired_ = perfect() && plain;
    if (as_wired_) return;
    const Message* const current = messages_.data() + base(posted_ - 1);
    for (std::size_t k = 0; k < order_.size(); ++k) deliverable_[k] = bounded(current[k]);
    LinkCounters counters;
    if (link_ != nullptr) link_->decide(t, round, {senders_, receivers_}, fates_);
    counters.lost = std::count(fates_.begin(), fates_.end(), Fate::lost);
    counters.late = std::count(fates_.begin(), fates_.end(), Fate::late);
    const std::size_t first_slot = base(posted_ - 1);
    std::size_t forged = depth_ * order_.size();
    for (std::size_t k = 0; k < order_.size(); ++k) {
      std::size_t place = first_[k];
      for (std::size_t e = first_[k]; e < first_[k + 1]; ++e) {
        if (lies_ && link_->lies(senders_[e])) {
          if (fates_[e] != Fate::delivered) continue;
          const Hop hop{t, round, senders_[e], order_[k], states_};
          if (!forge(hop, slots_[e], k, messages_[forged], counters, shape)) continue;
          delivered_[place] = static_cast<std::uint32_t>(forged++);
          delivered_from_[place++] = senders_[e];
          continue;
        }
        // Without branches: chance decides, which no processor can foresee.
        const bool here = fates_[e] == Fate::delivered;
        const bool taken = here & (deliverable_[slots_[e]] != 0);
        delivered_[place] = static_cast<std::uint32_t>(first_slot) + slots_[e];
        delivered_from_[place] = senders_[e];
        place += taken ? 1U : 0U;
        counters.sent += taken ? 1 : 0;
        counters.refused += here != taken ? 1 : 0;
      }
      received_[k] = place - first_[k];
    }
    if (link_ != nullptr) link_->counters += counters;
  }

  Inbox<Message> inbox(std::size_t k) const {
    const std::size_t due = first_[k + 1] - first_[k];
    if (as_wired_)
      return {messages_.data() + base(posted_ - 1), std::span(slots_).subspan(first_[k], due),
              senders_.data() + first_[k], static_cast<int>(due)};
    return {messages_.data(), std::span(delivered_).subspan(first_[k], received_[k]),
            delivered_from_.data() + first_[k], static_cast<int>(due)};
  }

 private:
  int agents() const { return static_cast<int>(order_.size()); }
  std::size_t size(const Message& m) const { return wire::size(m, agents()); }
  std::size_t base(std::uint64_t hop) const { return static_cast<std::size_t>(hop % depth_) * order_.size(); }
  /// A sample posts the messages of each round, and those after the last one.
  std::size_t posts_in(int samples) const {
    return static_cast<std::size_t>(samples) * static_cast<std::size_t>(rounds_ + 1);
  }

  /// Which states a message speaks of; families that send the whole state do not say.
  static std::span<const int> entries(const Message& message) {
    if constexpr (requires { message.entries(); })
      return message.entries();
    else
      return {};
  }

  /// Writes what a liar sends in place of the message of `sender`; false when nothing is to be delivered.
  template <class Shape>
  bool forge(const Hop& hop, std::uint32_t sender, std::size_t receiver, Message& message,
             LinkCounters& counters, const Shape& shape) {
    const std::size_t age = posts_in(link_->age(hop));
    if (age >= posted_) return ++counters.lost, false;  // nothing that old
    message = messages_[base(posted_ - 1 - age) + sender];
    shape(receiver, hop.sender, message);
    Hop told = hop;
    told.entries = entries(message);
    bool changed = false;
    if (!link_->rewrite(told, FieldList(message), changed)) return ++counters.lost, false;
    if (!bounded(message)) return ++counters.refused, false;
    return ++(changed ? counters.forged : counters.sent), true;
  }

  std::vector<int> order_;
  int states_;
  int rounds_;
  std::vector<std::size_t> first_;        // of each agent's slots, N+1
  std::vector<std::uint32_t> slots_;      // as wired: positions of the neighbours, by public id
  std::vector<int> senders_;              // their public ids
  std::vector<int> receivers_;            // of each slot
  std::vector<Fate> fates_;               // of what each slot carries this round
  std::vector<std::size_t> listeners_;    // of each agent
  std::vector<std::uint32_t> delivered_;  // as delivered this round: indices into messages_
  std::vector<int> delivered_from_;       // their senders
  std::vector<std::size_t> received_;     // how many of them
  std::vector<char> deliverable_;         // whether what an agent sent this round is finite and below kHuge
  std::vector<Message> messages_;
  std::size_t depth_ = 2;
  std::uint64_t posted_ = 0;
  bool as_wired_ = true;
  Link* link_ = nullptr;
  bool lies_ = false;  // some agent lies in its messages
};

}  // namespace garrison
