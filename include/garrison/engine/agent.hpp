// SPDX-License-Identifier: Apache-2.0
// One agent on its own, driven by hand or by a node.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "garrison/core/filter.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"

namespace garrison {

/// A message as a driver handles it: who sent it, and its numbers.
class GARRISON_EXPORT AnyMessage {
 public:
  explicit AnyMessage(int sender) : sender_(sender) {}
  virtual ~AnyMessage() = default;
  int sender() const { return sender_; }
  virtual std::vector<double> values() const = 0;

 private:
  int sender_;
};

/// The same agent as inside the engine: `sense` once per sample, then `fuse` once per round.
class GARRISON_EXPORT AnyAgent {
 public:
  virtual ~AnyAgent() = default;
  virtual int id() const = 0;
  virtual int rounds() const = 0;
  virtual void reset(const Vector& x0) = 0;
  /// `y`: one number per row of C_i, NaN = missing. Returns the first message to send.
  virtual std::shared_ptr<AnyMessage> sense(std::span<const double> y) = 0;
  /// Messages of the neighbours in any order; a missing neighbour is left out. A message that is not from a
  /// neighbour is refused; one with a number that is not finite is dropped and counted.
  virtual std::shared_ptr<AnyMessage> fuse(std::span<const std::shared_ptr<AnyMessage>> inbox) = 0;
  virtual Vector estimate() const = 0;
  virtual Report report() const = 0;
  /// What the agent does to its own plant until the next sample; NaN where the family has none.
  virtual double control() const = 0;
  virtual std::vector<int> accused() const = 0;
  virtual std::int64_t dropped() const = 0;
};

template <class F, int n>
class Agent final : public AnyAgent {
  static_assert(Filter<F, n>);
  using Message = typename F::template Message<n>;
  struct Letter final : AnyMessage {
    Letter(int sender, const Message& m) : AnyMessage(sender), message(m) {}
    std::vector<double> values() const override {
      const auto all = const_cast<Message&>(message).values();
      return {all.begin(), all.end()};
    }
    Message message;
  };

 public:
  Agent(std::shared_ptr<const typename F::Gains> gains, const Model& model, const Network& network, int id)
      : gains_(std::move(gains)),
        model_(model),
        neighbours_(network.neighbours(id).begin(), network.neighbours(id).end()),
        rows_(model.C(id)),
        local_{id,
               model.agents(),
               model.states(),
               model.outputs(id),
               network.degree(id),
               model_.A().data(),
               rows_.data()} {
    reset(Vector::Zero(model.states()));
  }
  Agent(const Agent&) = delete;
  Agent& operator=(const Agent&) = delete;

  int id() const override { return local_.id; }
  int rounds() const override { return F::rounds(*gains_); }

  void reset(const Vector& x0) override {
    if (x0.size() != local_.states)
      refuse("x0", std::to_string(x0.size()) + " numbers", std::to_string(local_.states) + ", one per state");
    const Vec<n> start = x0;
    F::template init<n>(local_, *gains_, start, state_, outgoing_);
    t_ = first_sample<F>() - 1;
    round_ = rounds();
    dropped_ = 0;
  }

  std::shared_ptr<AnyMessage> sense(std::span<const double> y) override {
    if (y.size() != static_cast<std::size_t>(local_.outputs))
      refuse("y", std::to_string(y.size()) + " numbers",
             std::to_string(local_.outputs) + ", one per row of C[" + std::to_string(local_.id) + "]");
    if (round_ < rounds())
      refuse("sense", "a call after " + std::to_string(round_) + " rounds", "fuse to be called first",
             "this filter needs " + std::to_string(rounds()) + " rounds per sample");
    F::template sense<n>(local_, *gains_, state_, y.data(), ++t_, outgoing_);
    round_ = 0;
    return std::make_shared<Letter>(local_.id, outgoing_);
  }

  std::shared_ptr<AnyMessage> fuse(std::span<const std::shared_ptr<AnyMessage>> inbox) override {
    if (round_ >= rounds())
      refuse("fuse", "a call after " + std::to_string(round_) + " rounds", "sense to be called first",
             "this filter needs " + std::to_string(rounds()) + " rounds per sample");
    std::vector<const Letter*> letters = sorted(inbox);
    mailbox_.clear();
    slots_.clear();
    for (const Letter* letter : letters) {
      mailbox_.push_back(letter->message);
      const auto values = mailbox_.back().values();
      if (std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
        slots_.push_back(static_cast<std::uint32_t>(mailbox_.size() - 1));
      else
        ++dropped_;
    }
    F::template fuse<n>(local_, *gains_, state_, Inbox<Message>(mailbox_.data(), slots_), round_, outgoing_);
    ++round_;
    return std::make_shared<Letter>(local_.id, outgoing_);
  }

  Vector estimate() const override { return F::template estimate<n>(state_); }
  Report report() const override { return F::template report<n>(local_, *gains_, state_); }
  double control() const override {
    if constexpr (requires { F::template control<n>(state_); })
      return F::template control<n>(state_);
    else
      return kNaN;
  }
  std::vector<int> accused() const override {
    std::vector<int> all;
    AgentSet built;
    const AgentSet* found = &built;
    if constexpr (requires { F::template accused_into<n>(state_, built); }) {
      built.resize(local_.agents);
      F::template accused_into<n>(state_, built);
    } else {
      found = F::template accused<n>(state_);
    }
    const AgentSet& set = *found;
    for (int i = 0; i < local_.agents && !set.empty(); ++i)
      if (set.contains(i)) all.push_back(i);
    return all;
  }
  std::int64_t dropped() const override { return dropped_; }

 private:
  std::vector<const Letter*> sorted(std::span<const std::shared_ptr<AnyMessage>> inbox) const {
    std::vector<const Letter*> letters;
    for (const auto& any : inbox) {
      const auto* letter = dynamic_cast<const Letter*>(any.get());
      if (letter == nullptr)
        refuse("inbox", "a message of another filter or dimension", "messages of the same filter");
      if (!std::binary_search(neighbours_.begin(), neighbours_.end(), letter->sender()))
        refuse("inbox", "a message from agent " + std::to_string(letter->sender()),
               "messages from neighbours of agent " + std::to_string(local_.id));
      letters.push_back(letter);
    }
    std::sort(letters.begin(), letters.end(), [](auto a, auto b) { return a->sender() < b->sender(); });
    const auto twice = std::adjacent_find(letters.begin(), letters.end(),
                                          [](auto a, auto b) { return a->sender() == b->sender(); });
    if (twice != letters.end())
      refuse("inbox", "two messages from agent " + std::to_string((*twice)->sender()),
             "one per neighbour and round");
    return letters;
  }

  std::shared_ptr<const typename F::Gains> gains_;
  Model model_;
  std::vector<int> neighbours_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows_;
  Local local_;
  typename F::template State<n> state_;
  Message outgoing_;
  std::vector<Message> mailbox_;
  std::vector<std::uint32_t> slots_;
  std::int64_t t_ = 0;
  int round_ = 0;
  std::int64_t dropped_ = 0;
};

}  // namespace garrison
