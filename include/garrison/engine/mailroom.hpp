// SPDX-License-Identifier: Apache-2.0
// The messages of a whole network, in one array.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/fields.hpp"
#include "garrison/core/inbox.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/certified_network.hpp"
#include "garrison/engine/routes.hpp"
#include "garrison/wire/message.hpp"

namespace garrison {

/// Messages of the last rounds, and an inbox for everybody. Which of them an agent may read is decided by
/// Routes, which is compiled once; here is what depends on what a message is.
/// Threads: one at a time.
template <class Message>
class Mailroom {
 public:
  /// `order`: engine position -> public id. `states`: n of the plant; `rounds` per sample.
  Mailroom(const Network& network, std::span<const int> order, int states, int rounds)
      : routes_(network, order, states, rounds) {
    connect(nullptr);
  }

  /// Starts a run over `link` (null = perfect).
  void connect(Link* link) { messages_.resize(routes_.connect(link)); }
  /// Copies the freshly initialised outgoing messages everywhere, so that later copies find their memory.
  /// @throws InvalidInput when an agent is to lie about what these messages do not hold
  void fill(CertifiedNetwork* certified) {
    const std::size_t N = agents();
    for (std::size_t k = N; k < messages_.size(); ++k) messages_[k] = messages_[k % N];
    if (certified != nullptr) certified->keep_lies(messages_.size() - routes_.first_lie());
    if (routes_.link() != nullptr) routes_.link()->require(fields(messages_.front(), certified, 0, 0));
  }

  /// Bytes of the bodies that all links carry in this round when no message is lost.
  std::int64_t bytes() const {
    const Message* const current = messages_.data() + routes_.current();
    std::size_t sum = 0;
    for (std::size_t k = 0; k < agents(); ++k) sum += routes_.listeners(k) * size(current[k]);
    return static_cast<std::int64_t>(sum);
  }
  /// Whether bodies grow and shrink with what they hold.
  bool variable() const {
    bool any = false;
    for (const Message& m : messages_) any |= wire::varies(m, routes_.agents());
    return any;
  }

  const Routes& routes() const { return routes_; }
  /// Where agents write; becomes current with `post`.
  Message* outgoing() { return messages_.data() + routes_.outgoing(); }
  void post() { routes_.post(); }

  /// Prepares the inboxes of one round from the current messages. `plain`: as in Engine::rounds.
  /// `shape(receiver, sender, message)` derives what a message does not carry. `certified`: what it has said
  /// in this round travels with them; null = nothing.
  template <class Shape>
  void collect(std::int64_t t, int round, bool plain, const Shape& shape, CertifiedNetwork* certified) {
    if (routes_.as_wired(plain)) return;
    const Message* const current = messages_.data() + routes_.current();
    for (std::size_t k = 0; k < agents(); ++k) routes_.deliverable(k, bounded(current[k]));
    routes_.deliver(t, round, Letters<Shape>(*this, shape, certified));
  }

  /// What agent k has sent; what is in any place of Routes.
  const Message& current(std::size_t k) const { return messages_[routes_.current() + k]; }
  const Message& at(std::size_t place) const { return messages_[place]; }

  Inbox<Message> inbox(std::size_t k) const {
    const Heard heard = routes_.heard(k);
    return {messages_.data() + heard.begin, heard.slots, heard.senders, heard.due};
  }

 private:
  template <class Shape>
  class Letters final : public Routes::Letters {
   public:
    Letters(Mailroom& room, const Shape& shape, CertifiedNetwork* certified)
        : room_(room), shape_(shape), certified_(certified) {}
    Routes::Letter copy(std::size_t from, std::size_t to, std::size_t k, int sender) const override {
      Message& message = room_.messages_[to];
      message = room_.messages_[from];
      shape_(k, sender, message);
      return {fields(message, certified_, to - room_.routes_.first_lie(), sender), entries(message)};
    }
    bool deliverable(std::size_t at) const override {
      return bounded(room_.messages_[at]) &&
             (certified_ == nullptr || bounded(certified_->lie(at - room_.routes_.first_lie())));
    }

   private:
    Mailroom& room_;
    const Shape& shape_;
    CertifiedNetwork* certified_;
  };

  /// What a liar can change: the message, and in its `place` a copy of what `sender` said for the
  /// certificate.
  static FieldList fields(Message& message, CertifiedNetwork* certified, std::size_t place, int sender) {
    return certified == nullptr ? FieldList(message) : FieldList(message, certified->copy(place, sender));
  }

  std::size_t agents() const { return static_cast<std::size_t>(routes_.agents()); }
  std::size_t size(const Message& m) const { return wire::size(m, routes_.agents()); }

  /// Which states a message speaks of; families that send the whole state do not say.
  static std::span<const int> entries(const Message& message) {
    if constexpr (requires { message.entries(); })
      return message.entries();
    else
      return {};
  }

  Routes routes_;
  std::vector<Message> messages_;
};

}  // namespace garrison
