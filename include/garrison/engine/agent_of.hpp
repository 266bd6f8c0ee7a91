// SPDX-License-Identifier: Apache-2.0
// The agent of one family and dimension.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/engine/agent.hpp"
#include "garrison/engine/evidence_shelf.hpp"
#include "garrison/wire/archive.hpp"
#include "garrison/wire/blake2b.hpp"
#include "garrison/wire/message.hpp"

namespace garrison {

/// Threads: one at a time.
template <class F, int n>
class AgentOf final : public Agent {
  static_assert(Filter<F, n>);
  using Gains = typename F::Gains;
  using State = typename F::template State<n>;
  using Message = typename F::template Message<n>;

 public:
  AgentOf(std::shared_ptr<const Gains> gains, AgentPart part,
          std::unique_ptr<certificate::Certifier> certifier = nullptr)
      : gains_(std::move(gains)),
        part_(std::move(part)),
        local_{part_.id,
               part_.agents,
               static_cast<int>(part_.A.rows()),
               static_cast<int>(part_.C_transposed.cols()),
               static_cast<int>(part_.neighbours.size()),
               part_.A.data(),
               part_.C_transposed.data()},
        rounds_(F::rounds(*gains_)),
        certifier_(std::move(certifier)) {
    const std::size_t places = 2 * static_cast<std::size_t>(rounds_) * part_.neighbours.size();
    arrived_.assign(places, kNever);
    slots_.reserve(part_.neighbours.size());
    senders_.reserve(part_.neighbours.size());
    silence_.assign(static_cast<std::size_t>(local_.outputs), kNaN);
    set_state(Vector::Zero(local_.states), start());
    mailbox_.assign(places, outgoing_);
    if (certifier_) evidence_.emplace(*certifier_, part_.neighbours, places);
    Message any = outgoing_;
    most_bytes_ = 0;
    const auto look_at = [&](int sender, certificate::Evidence& said) {
      shape<F, n>(local_, *gains_, sender, first_sample<F>(), any);
      if (certifier_) certifier_->shape_evidence(sender, said);
      most_bytes_ = std::max(most_bytes_, with_evidence(any, said, [&](const auto& body) {
                               return wire::most_bytes(body, local_.agents);
                             }));
    };
    look_at(local_.id, said_);
    for (const int j : part_.neighbours) {
      certificate::Evidence any_evidence;
      look_at(j, any_evidence);
    }
    snapshot_bytes_ = kHead + written({}) + 8;
  }
  AgentOf(const AgentOf&) = delete;
  AgentOf& operator=(const AgentOf&) = delete;

  std::string_view family() const override { return F::name; }
  int id() const override { return local_.id; }
  int agents() const override { return local_.agents; }
  int states() const override { return local_.states; }
  int outputs() const override { return local_.outputs; }
  int rounds() const override { return rounds_; }
  std::span<const int> neighbours() const override { return part_.neighbours; }
  std::size_t most_bytes() const override { return most_bytes_; }
  std::int64_t sample() const override { return t_; }
  int round() const override { return round_; }
  std::int64_t start() const override { return first_sample<F>() - 1; }

  Refusal reset(const Vector& x0, std::int64_t t) override {
    if (x0.size() != local_.states) return Refusal::size;
    if (!usable<Dynamic>(x0)) return Refusal::number;
    if (t < start()) return Refusal::late;
    if (t > kLatest) return Refusal::early;
    set_state(x0, t);
    return Refusal::none;
  }

  Sent sense(std::int64_t t, std::span<const double> y, std::span<std::byte> out) noexcept override {
    if (round_ < rounds_) return {Refusal::order};
    if (t <= t_) return {Refusal::late};
    if (t - t_ > kMostGap + 1) return {Refusal::early};
    if (y.size() != static_cast<std::size_t>(local_.outputs) || out.size() < most_bytes_)
      return {Refusal::size};
    while (t_ + 1 < t) miss_one();
    begin(t, y.data());
    return send(out);
  }

  Refusal deliver(const Envelope& envelope, std::span<const std::byte> body) noexcept override {
    const std::size_t neighbour = neighbour_of(envelope.sender);
    if (neighbour == part_.neighbours.size()) return Refusal::stranger;
    const std::int64_t t = envelope.sample;
    if (envelope.round < 0) return Refusal::early;
    if (t < t_ || (t == t_ && envelope.round < round_)) return Refusal::late;
    if (t > t_ + 1 || envelope.round >= rounds_) return Refusal::early;
    const std::size_t at = place(t, envelope.round, neighbour);
    if (arrived_[at] == t) return Refusal::duplicate;
    shape<F, n>(local_, *gains_, envelope.sender, t, mailbox_[at]);
    const Refusal refusal = decode(body, at, neighbour);
    if (refusal == Refusal::none) arrived_[at] = t;
    return refusal;
  }

  bool has(int sender) const noexcept override {
    const std::size_t neighbour = neighbour_of(sender);
    if (neighbour == part_.neighbours.size() || round_ >= rounds_) return false;
    return arrived_[place(t_, round_, neighbour)] == t_;
  }

  Sent fuse(std::span<std::byte> out) noexcept override {
    if (round_ >= rounds_ || listening_) return {Refusal::order};
    if (out.size() < most_bytes_) return {Refusal::size};
    fuse_round(inbox());
    return send(out);
  }

  Refusal listen(std::int64_t t) noexcept override {
    if (round_ < rounds_ && !listening_) return Refusal::order;
    if (t <= t_ && !(listening_ && t == t_)) return Refusal::late;
    if (t > kLatest) return Refusal::early;
    t_ = t;
    round_ = 0;
    listening_ = true;
    if (certifier_) certifier_->begin(t, silence_.data());
    return Refusal::none;
  }
  Refusal join() noexcept override {
    if (!listening_) return Refusal::order;
    const Inbox<Message> heard = inbox();
    F::template rejoin<n>(local_, *gains_, heard, t_, state_);
    if (certifier_) {
      hear_evidence(heard);
      certifier_->end_sample();
    }
    uncover();
    round_ = rounds_;
    listening_ = false;
    fresh_ = heard.size() == 0;
    return Refusal::none;
  }
  void uncover() noexcept override { garrison::uncover<F, n>(*gains_, state_); }

  Report report() const noexcept override {
    Report found = F::template report<n>(local_, *gains_, state_);
    const Vec<n>& x = F::template estimate<n>(state_);
    const Bound bound = certificate::least(found.bound, found.kind, certifier_.get(),
                                           {x.data(), static_cast<std::size_t>(x.size())});
    found.bound = bound.value;
    found.kind = bound.kind;
    return found;
  }
  void estimate(std::span<double> out) const noexcept override {
    const Vec<n>& x = F::template estimate<n>(state_);
    std::copy_n(x.data(), std::min(out.size(), static_cast<std::size_t>(x.size())), out.data());
  }
  double control() const noexcept override {
    if constexpr (requires { F::template control<n>(state_); })
      return F::template control<n>(state_);
    else
      return kNaN;
  }
  std::vector<int> accused() const override {
    std::vector<int> all;
    AgentSet built;
    const AgentSet* set = &built;
    if constexpr (requires { F::template accused_into<n>(state_, built); }) {
      built.resize(local_.agents);
      F::template accused_into<n>(state_, built);
    } else {
      set = F::template accused<n>(state_);
    }
    for (int i = 0; i < local_.agents && !set->empty(); ++i)
      if (set->contains(i)) all.push_back(i);
    return all;
  }
  std::int64_t resets() const noexcept override { return resets_; }

  std::size_t snapshot_bytes() const noexcept override { return snapshot_bytes_; }
  std::size_t save(std::span<std::byte> out) const noexcept override {
    if (round_ < rounds_ || out.size() < snapshot_bytes_) return 0;
    std::byte* at = out.data();
    wire::store(at, kMagic);
    wire::store(at + 4, static_cast<std::uint32_t>(local_.id));
    wire::store(at + 8, part_.design);
    wire::store(at + 16, static_cast<std::uint64_t>(t_));
    wire::store(at + 24, static_cast<std::uint64_t>(resets_));
    const std::size_t end = kHead + written(out.subspan(kHead, snapshot_bytes_ - kHead - 8));
    if (end + 8 != snapshot_bytes_) return 0;
    wire::store(at + end, wire::checksum(out.first(end)));
    return snapshot_bytes_;
  }
  Refusal load(std::span<const std::byte> snapshot) noexcept override {
    if (round_ < rounds_) return Refusal::order;
    if (snapshot.size() != snapshot_bytes_) return Refusal::size;
    const std::byte* at = snapshot.data();
    if (wire::load<std::uint32_t>(at) != kMagic || wire::load<std::uint64_t>(at + 8) != part_.design ||
        wire::load<std::uint32_t>(at + 4) != static_cast<std::uint32_t>(local_.id))
      return Refusal::foreign;
    const std::size_t end = snapshot_bytes_ - 8;
    if (wire::load<std::uint64_t>(at + end) != wire::checksum(snapshot.first(end))) return Refusal::damaged;
    wire::Reader reader(snapshot.subspan(kHead, end - kHead), local_.agents, false);
    reader("", state_);
    if (certifier_) reader("certificate", certifier_->memory());
    const auto t = static_cast<std::int64_t>(wire::load<std::uint64_t>(at + 16));
    const bool certified = !certifier_ || (certifier_->usable() && certifier_->memory().t == t);
    if (reader.end() != Refusal::none || t < start() || t > kLatest || !certified) {
      // Somebody forged a checksum: nothing of it may stay.
      Vec<n> zero = Vec<n>::Zero(local_.states);
      F::template init<n>(local_, *gains_, zero, state_, outgoing_);
      if (certifier_) certifier_->reset(t_);
      uncover();
      return Refusal::damaged;
    }
    t_ = t;
    resets_ = static_cast<std::int64_t>(wire::load<std::uint64_t>(at + 24));
    std::fill(arrived_.begin(), arrived_.end(), kNever);
    return Refusal::none;
  }

  std::vector<wire::FieldInfo> fields(int sender, std::int64_t t) override {
    Message any = outgoing_;
    shape<F, n>(local_, *gains_, sender, t, any);
    std::vector<wire::FieldInfo> all;
    const auto list = [&](const FieldList& of) {
      for (const FieldRef& field : of.all()) {
        int size = field.size;
        if (field.kind == FieldKind::set)
          size = static_cast<AgentSet*>(field.data)->empty() ? 0 : local_.agents;
        if (field.kind == FieldKind::labels) size = static_cast<LabelSet*>(field.data)->capacity();
        all.push_back({std::string(field.name), field.kind, size});
      }
    };
    list(FieldList(any));
    certificate::Evidence evidence;
    if (certifier_) {
      certifier_->shape_evidence(sender, evidence);
      list(FieldList(evidence));
    }
    return all;
  }

 private:
  static constexpr std::uint32_t kMagic = 0x31535047;  // "GPS1"
  static constexpr std::size_t kHead = 32;
  static constexpr std::int64_t kNever = INT64_MIN;
  static constexpr std::int64_t kLatest = INT64_MAX / 4;

  void set_state(const Vector& x0, std::int64_t t) {
    const Vec<n> x = x0;
    F::template init<n>(local_, *gains_, x, state_, outgoing_);
    fresh_ = t != start();
    if (fresh_) uncover();
    t_ = t;
    round_ = rounds_;
    listening_ = lost_ = false;
    resets_ = 0;
    if (certifier_) certifier_->reset(t);
    std::fill(arrived_.begin(), arrived_.end(), kNever);
  }

  void begin(std::int64_t t, const double* y) noexcept {
    t_ = t;
    round_ = 0;
    F::template sense<n>(local_, *gains_, state_, y, t, outgoing_);
    if (certifier_) certifier_->begin(t, y);
    lost_ = fresh_ || !usable<n>(F::template estimate<n>(state_));
    if (rounds_ == 0 && lost_) rejoin({nullptr, {}, nullptr, 0});
  }
  void miss_one() noexcept {
    begin(t_ + 1, silence_.data());
    slots_.clear();
    senders_.clear();
    while (round_ < rounds_) fuse_round({mailbox_.data(), slots_, senders_.data(), local_.degree});
    uncover();
  }
  void fuse_round(const Inbox<Message>& inbox) noexcept {
    F::template fuse<n>(local_, *gains_, state_, inbox, round_, outgoing_);
    if (certifier_) {
      hear_evidence(inbox);
      certifier_->end_round(round_);
    }
    if (++round_ == rounds_ && lost_) rejoin(inbox);
  }
  void rejoin(const Inbox<Message>& inbox) noexcept {
    F::template rejoin<n>(local_, *gains_, inbox, t_, state_);
    resets_ += fresh_ ? 0 : 1;
    fresh_ = false;
  }
  Inbox<Message> inbox() noexcept {
    slots_.clear();
    senders_.clear();
    for (std::size_t k = 0; k < part_.neighbours.size(); ++k) {
      const std::size_t at = place(t_, round_, k);
      if (arrived_[at] != t_) continue;
      slots_.push_back(static_cast<std::uint32_t>(at));
      senders_.push_back(part_.neighbours[k]);
    }
    return {mailbox_.data(), slots_, senders_.data(), local_.degree};
  }
  Sent send(std::span<std::byte> out) noexcept {
    if (fresh_ || !bounded(outgoing_)) return {};
    if (certifier_ && round_ < rounds_) certifier_->say(round_, said_);
    return {Refusal::none, with_evidence(outgoing_, said_, [&](const auto& body) {
              return wire::encode(body, local_.agents, out.data());
            })};
  }

  /// A message as it travels: behind the family's fields those of the certificate, if there is one.
  struct Both {
    Message& message;
    certificate::Evidence& evidence;
    template <class V>
    void visit(V& v) {
      message.visit(v);
      evidence.visit(v);
    }
  };
  template <class Use>
  std::size_t with_evidence(Message& message, certificate::Evidence& evidence,
                            const Use& use) const noexcept {
    return certifier_ ? use(Both{message, evidence}) : use(message);
  }
  Refusal decode(std::span<const std::byte> body, std::size_t place, std::size_t neighbour) noexcept {
    if (!certifier_) return wire::decode(body, local_.agents, mailbox_[place]);
    Both both{mailbox_[place], evidence_->open(place, neighbour)};
    return wire::decode(body, local_.agents, both);
  }
  void hear_evidence(const Inbox<Message>& inbox) noexcept {
    std::size_t neighbour = 0;  // both are in ascending order
    for (std::size_t k = 0; k < inbox.size(); ++k) {
      while (part_.neighbours[neighbour] != inbox.sender(k)) ++neighbour;
      certifier_->hear(round_, inbox.sender(k), evidence_->take(slots_[k], neighbour));
    }
  }

  /// Place of an agent among the neighbours; their number when it is none of them.
  std::size_t neighbour_of(int agent) const noexcept {
    const auto at = std::lower_bound(part_.neighbours.begin(), part_.neighbours.end(), agent);
    if (at != part_.neighbours.end() && *at != agent) return part_.neighbours.size();
    return static_cast<std::size_t>(at - part_.neighbours.begin());
  }
  /// Two samples of all rounds: messages of the next sample may come early.
  std::size_t place(std::int64_t t, int round, std::size_t neighbour) const noexcept {
    const auto side = static_cast<std::size_t>(static_cast<std::uint64_t>(t) & 1U);
    return (side * static_cast<std::size_t>(rounds_) + static_cast<std::size_t>(round)) *
               part_.neighbours.size() +
           neighbour;
  }

  /// Writes the state; how many bytes that takes.
  std::size_t written(std::span<std::byte> out) const noexcept {
    wire::FixedSink sink(out);
    wire::Writer<wire::FixedSink> writer(sink);
    writer("", const_cast<State&>(state_));  // only read
    if (certifier_) writer("certificate", certifier_->memory());
    return sink.used();
  }

  std::shared_ptr<const Gains> gains_;
  AgentPart part_;
  Local local_;
  int rounds_;
  std::unique_ptr<certificate::Certifier> certifier_;  // null: no certificate was asked for
  State state_;
  Message outgoing_;
  std::vector<Message> mailbox_;
  std::optional<EvidenceShelf> evidence_;  // of the message in each place; none without a certificate
  certificate::Evidence said_;
  std::vector<std::int64_t> arrived_;  // the sample that the message in each place is of
  std::vector<std::uint32_t> slots_;   // of the round that is being fused
  std::vector<int> senders_;
  std::vector<double> silence_;  // measurements of a sample that was missed
  std::size_t most_bytes_ = 0;
  std::size_t snapshot_bytes_ = 0;
  std::int64_t t_ = 0;
  std::int64_t resets_ = 0;
  int round_ = 0;
  bool listening_ = false;
  bool fresh_ = false;  // has just started in a running network: says nothing before it has heard the others
  bool lost_ = false;   // the estimate is of no use, or nobody knows: rejoins after the last round
};

}  // namespace garrison
