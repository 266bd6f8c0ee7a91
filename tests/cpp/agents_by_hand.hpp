// SPDX-License-Identifier: Apache-2.0
// All agents of a network, each on its own and driven by bytes, as nodes would be.
#pragma once

#include <doctest/doctest.h>

#include <memory>
#include <span>
#include <vector>

#include "garrison/engine/any_filter.hpp"
#include "garrison/engine/link.hpp"

namespace garrison::test {

/// What becomes of one message.
inline Fate fate(const Link& link, const Envelope& message, int receiver) {
  Fate found = Fate::lost;
  link.decide(message.sample, message.round, {{&message.sender, 1}, {&receiver, 1}}, {&found, 1});
  return found;
}

class AgentsByHand {
 public:
  /// `link`: what becomes of honest messages; null = perfect.
  AgentsByHand(const Prepared& prepared, const Network& network, const Link* link = nullptr)
      : network_(network), link_(link) {
    for (int i = 0; i < network.agents(); ++i) agents_.push_back(prepared.agent(i));
  }
  std::vector<std::unique_ptr<Agent>>& all() { return agents_; }
  Agent& operator[](int i) { return *agents_[static_cast<std::size_t>(i)]; }

  /// One sample; y(i): measurements of agent i. Agents that are `absent` take no part.
  template <class Measurements>
  void step(std::int64_t t, const Measurements& y, int absent = -1) {
    std::vector<std::vector<std::byte>> sent(agents_.size());
    const auto send = [&](std::size_t i, Agent::Sent result, std::vector<std::byte>& body) {
      REQUIRE(result.refusal == Refusal::none);
      body.resize(result.bytes);
      sent[i] = body;
    };
    const auto room = [&](std::size_t i) { return std::vector<std::byte>(agents_[i]->most_bytes()); };
    for (std::size_t i = 0; i < agents_.size(); ++i) {
      if (static_cast<int>(i) == absent) continue;
      const Vector measured = y(static_cast<int>(i));
      auto body = room(i);
      const auto result =
          agents_[i]->sense(t, {measured.data(), static_cast<std::size_t>(measured.size())}, body);
      send(i, result, body);
    }
    for (int round = 0; round < agents_.front()->rounds(); ++round) {
      for (std::size_t i = 0; i < agents_.size(); ++i) deliver(static_cast<int>(i), t, round, sent, absent);
      for (std::size_t i = 0; i < agents_.size(); ++i) {
        if (static_cast<int>(i) == absent) continue;
        auto body = room(i);
        const auto result = agents_[i]->fuse(body);
        send(i, result, body);
      }
    }
  }

  template <class Numbers>
  void append_estimates(Numbers& out) const {
    for (const auto& agent : agents_) {
      const std::size_t at = out.size();
      out.resize(at + static_cast<std::size_t>(agent->states()));
      agent->estimate({out.data() + at, static_cast<std::size_t>(agent->states())});
    }
  }

 private:
  /// From the highest id down: the order of arrival must not matter.
  void deliver(int receiver, std::int64_t t, int round, const std::vector<std::vector<std::byte>>& sent,
               int absent) {
    const auto heard = network_.neighbours(receiver);
    for (auto j = heard.rbegin(); j != heard.rend(); ++j) {
      const auto& body = sent[static_cast<std::size_t>(*j)];
      const Envelope envelope{*j, t, round};
      if (*j == absent || receiver == absent || body.empty()) continue;
      if (link_ != nullptr && fate(*link_, envelope, receiver) != Fate::delivered) continue;
      REQUIRE(agents_[static_cast<std::size_t>(receiver)]->deliver(envelope, body) == Refusal::none);
    }
  }

  const Network& network_;
  const Link* link_;
  std::vector<std::unique_ptr<Agent>> agents_;
};

}  // namespace garrison::test
