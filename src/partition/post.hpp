// SPDX-License-Identifier: Apache-2.0
// The messages of one rank: what engine/mailroom.hpp is for a whole network. Loss, delay and lies are decided
// here, where a message is received: they follow from (sender, receiver, sample, round) alone, so the
// sender's rank need not know.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/fields.hpp"
#include "garrison/core/inbox.hpp"
#include "garrison/engine/link.hpp"
#include "partition/raw_message.hpp"
#include "partition/region.hpp"

namespace garrison::partition {

/// A ring of buffers with a message per place, ghosts included, and behind them a place per lying edge.
/// Threads: one at a time.
template <class Message>
class Post {
 public:
  /// `names`: what the family calls the agent at each place. `states`: n of the plant; `rounds` per sample.
  Post(const Region& region, Exchange& exchange, std::span<const int> names, int states, int rounds)
      : region_(region), exchange_(exchange), names_(names), states_(states), rounds_(rounds) {}

  /// Starts a run over `link` (null = perfect) from the messages that `outgoing` gets next.
  void connect(Link* link) {
    link_ = link;
    depth_ = 2 + (link == nullptr ? 0 : posts_in(link->memory()));
    posted_ = 0;
    std::size_t lies = 0;
    if (link != nullptr) {
      from_.clear();
      to_.clear();
      for (int k = 0; k < region_.listed(); ++k)
        for (std::size_t e = region_.first[at(k)]; e < region_.first[at(k) + 1]; ++e) {
          from_.push_back(region_.ids[static_cast<std::size_t>(region_.heard[e])]);
          to_.push_back(region_.ids[at(k)]);
          lies += link->lies(from_.back()) ? 1 : 0;
        }
      fates_.assign(from_.size(), Fate::delivered);
    }
    lies_ = lies > 0;
    messages_.resize(depth_ * places() + lies);
  }
  /// Copies the initial messages of the own agents everywhere, so that later copies find their memory.
  /// `shape(place, message)` gives a message the form that its sender's have; `state`: bytes that are sent
  /// with each.
  template <class Shape>
  void fill(std::size_t state, const Shape& shape) {
    for (std::size_t k = static_cast<std::size_t>(region_.own); k < messages_.size(); ++k) {
      if (k < places()) {
        messages_[k] = messages_[0];
        shape(k, messages_[k]);
      } else {
        messages_[k] = messages_[k % places()];
      }
    }
    std::int64_t own_most = 0;
    for (std::size_t k = 0; k < places(); ++k)
      own_most = std::max(own_most, static_cast<std::int64_t>(raw_size(messages_[k])));
    double most[] = {static_cast<double>(own_most), static_cast<double>(state)};
    exchange_.largest(most);
    message_ = static_cast<std::size_t>(most[0]);
    record_ = (message_ + static_cast<std::size_t>(most[1]) + 7) / 8 * 8;
    out_.resize(record_ * region_.packed.size());
    in_.resize(record_ * static_cast<std::size_t>(region_.ghosts()));
  }

  bool perfect() const { return link_ == nullptr || link_->perfect(); }
  Message* outgoing() { return messages_.data() + base(posted_); }
  void post() { ++posted_; }

  /// Sends the current messages of the own agents to the ranks that hear them; `state(place, bytes)` writes
  /// what goes with each.
  template <class State>
  void send(const State& state) {
    if (senders_.empty())  // families that average all at once may never need them
      for (const std::int32_t place : region_.heard)
        senders_.push_back(names_[static_cast<std::size_t>(place)]);
    const Message* const now = current();
    for (std::size_t k = 0; k < region_.packed.size(); ++k) {
      write_raw(now[region_.packed[k]], out_.data() + k * record_);
      state(region_.packed[k], std::span(out_).subspan(k * record_ + message_, record_ - message_));
    }
    exchange_.begin(out_.data(), in_.data(), record_);
  }
  /// Ends `send`; `shape(place, message)` as in `fill`, `state(place, bytes)` reads.
  template <class Shape, class State>
  void receive(const Shape& shape, const State& state) {
    exchange_.finish();
    Message* const now = messages_.data() + base(posted_ - 1);
    for (std::size_t k = 0; k < static_cast<std::size_t>(region_.ghosts()); ++k) {
      const std::int32_t place = region_.arrival[k];
      shape(at(place), now[place]);
      read_raw(in_.data() + k * record_, now[place]);
      state(place, std::span<const std::byte>(in_).subspan(k * record_ + message_, record_ - message_));
    }
  }

  /// Whether all messages reach everybody as they are: inboxes of interior agents are then ready after
  /// `send`.
  bool as_wired(bool plain) { return as_wired_ = perfect() && plain; }

  /// Prepares the inboxes of one round, of the places below `end`, from the current messages; counts what own
  /// agents get. `plain`: no estimate of the whole network
  /// is lost. `shape(receiver, sender, message)`: places; derives what a message does not carry.
  template <class Shape>
  void collect(std::int64_t t, int round, bool plain, int end, const Shape& shape) {
    as_wired_ = perfect() && plain;
    if (as_wired_) return;
    delivered_.resize(region_.heard.size());
    delivered_from_.resize(region_.heard.size());
    received_.resize(at(region_.listed()));
    deliverable_.resize(places());
    for (std::size_t k = 0; k < places(); ++k) deliverable_[k] = bounded(current()[k]) ? 1 : 0;
    const std::size_t links = region_.first[at(end)];
    if (link_ != nullptr)
      link_->decide(t, round, {std::span(from_).first(links), std::span(to_).first(links)},
                    std::span(fates_).first(links));
    LinkCounters counters;
    LinkCounters of_ghosts;  // their own ranks count these
    std::size_t forged = depth_ * places();
    for (int k = 0; k < end; ++k) {
      LinkCounters& counted = k < region_.own ? counters : of_ghosts;
      std::size_t next = region_.first[at(k)];
      for (std::size_t e = region_.first[at(k)]; e < region_.first[at(k) + 1]; ++e) {
        const Fate fate = link_ == nullptr ? Fate::delivered : fates_[e];
        counted.lost += fate == Fate::lost ? 1 : 0;
        counted.late += fate == Fate::late ? 1 : 0;
        if (fate != Fate::delivered) continue;
        const auto sender = static_cast<std::size_t>(region_.heard[e]);
        if (lies_ && link_->lies(from_[e])) {
          const Hop hop{t, round, from_[e], to_[e], states_};
          if (!forge(hop, sender, k, messages_[forged], counted, shape)) continue;
          delivered_[next] = static_cast<std::uint32_t>(forged++);
        } else if (deliverable_[sender] != 0) {
          delivered_[next] = static_cast<std::uint32_t>(base(posted_ - 1) + sender);
          ++counted.sent;
        } else {
          ++counted.refused;
          continue;
        }
        delivered_from_[next++] = senders_[e];
      }
      received_[at(k)] = next - region_.first[at(k)];
    }
    if (link_ != nullptr) link_->counters += counters;
  }

  Inbox<Message> inbox(int place) const {
    const std::size_t first = region_.first[at(place)];
    const std::size_t due = region_.first[at(place) + 1] - first;
    if (as_wired_)
      return {current(), wired().subspan(first, due), senders_.data() + first, static_cast<int>(due)};
    return {messages_.data(), std::span(delivered_).subspan(first, received_[at(place)]),
            delivered_from_.data() + first, static_cast<int>(due)};
  }

 private:
  static std::size_t at(int place) { return static_cast<std::size_t>(place); }
  std::size_t places() const { return region_.ids.size(); }
  std::size_t base(std::uint64_t hop) const { return static_cast<std::size_t>(hop % depth_) * places(); }
  const Message* current() const { return messages_.data() + base(posted_ - 1); }
  std::span<const std::uint32_t> wired() const {
    return {reinterpret_cast<const std::uint32_t*>(region_.heard.data()), region_.heard.size()};
  }
  /// A sample posts the messages of each round, and those after the last one.
  std::size_t posts_in(int samples) const {
    return static_cast<std::size_t>(samples) * static_cast<std::size_t>(rounds_ + 1);
  }

  /// Writes what a liar sends in place of its message; false when nothing is to be delivered.
  template <class Shape>
  bool forge(const Hop& hop, std::size_t sender, int receiver, Message& message, LinkCounters& counters,
             const Shape& shape) {
    const std::size_t age = posts_in(link_->age(hop));
    if (age >= posted_) return ++counters.lost, false;  // nothing that old
    message = messages_[base(posted_ - 1 - age) + sender];
    shape(receiver, sender, message);
    Hop told = hop;
    if constexpr (requires { message.entries(); }) told.entries = message.entries();
    bool changed = false;
    if (!link_->rewrite(told, FieldList(message), changed)) return ++counters.lost, false;
    if (!bounded(message)) return ++counters.refused, false;
    return ++(changed ? counters.forged : counters.sent), true;
  }

  const Region& region_;
  Exchange& exchange_;
  std::span<const int> names_;
  int states_;
  int rounds_;
  std::vector<int> senders_;  // names behind `Region::heard`
  std::vector<int> from_;     // public ids behind `Region::heard`; only with a link
  std::vector<int> to_;
  std::vector<Fate> fates_;
  std::vector<std::uint32_t> delivered_;
  std::vector<int> delivered_from_;
  std::vector<std::size_t> received_;
  std::vector<char> deliverable_;
  std::vector<Message> messages_;
  std::vector<std::byte> out_;
  std::vector<std::byte> in_;
  std::size_t message_ = 0;  // bytes of a message between ranks
  std::size_t record_ = 0;   // and of what goes with it
  std::size_t depth_ = 2;
  std::uint64_t posted_ = 0;
  bool as_wired_ = true;
  Link* link_ = nullptr;
  bool lies_ = false;  // some agent that is heard here lies
};

}  // namespace garrison::partition
