// SPDX-License-Identifier: Apache-2.0
// The agent of one family and dimension.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "garrison/engine/agent.hpp"
#include "garrison/engine/agent_evidence.hpp"
#include "garrison/engine/agent_mail.hpp"
#include "garrison/engine/agent_plant.hpp"
#include "garrison/engine/follows.hpp"
#include "garrison/engine/snapshot_head.hpp"
#include "garrison/wire/archive.hpp"
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
        local_(local_of(part_)),
        rounds_(F::rounds(*gains_)),
        mail_(part_.neighbours, rounds_),
        evidence_(std::move(certifier), part_.neighbours, mail_.places(), part_.id, part_.agents),
        silence_(static_cast<std::size_t>(local_.outputs), kNaN) {
    set_state(Vector::Zero(local_.states), start());
    mailbox_.assign(mail_.places(), outgoing_);
    look_at(local_.id);
    for (const int j : part_.neighbours) look_at(j);
    snapshot_bytes_ = written({}) + SnapshotHead::kAround;
  }
  AgentOf(const AgentOf&) = delete;
  AgentOf& operator=(const AgentOf&) = delete;

  std::string_view family() const override { return F::name; }
  std::uint64_t design() const override { return part_.design; }
  const AgentPart& part() const noexcept override { return part_; }
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

  Refusal vary(const Change& plant) override {
    if (round_ < rounds_ || listening_) return Refusal::order;
    if (evidence_ || !may_vary_) return Refusal::foreign;
    return plant_.take(plant, part_, local_);
  }

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
    if (t > t_ + kMostGap + 1) return {Refusal::early};
    if (y.size() != static_cast<std::size_t>(local_.outputs) || out.size() < most_bytes_)
      return {Refusal::size};
    while (t_ + 1 < t) miss_one();
    begin(t, y.data());
    return send(out);
  }

  Refusal deliver(const Envelope& envelope, std::span<const std::byte> body) noexcept override {
    const std::size_t neighbour = mail_.neighbour_of(envelope.sender);
    if (neighbour == part_.neighbours.size()) return Refusal::stranger;
    const std::int64_t t = envelope.sample;
    if (envelope.round < 0) return Refusal::early;
    if (t < t_ || (t == t_ && envelope.round < round_)) return Refusal::late;
    if (t > t_ + 1 || envelope.round >= rounds_) return Refusal::early;
    const std::size_t at = mail_.place(t, envelope.round, neighbour);
    if (mail_.has(at, t)) return Refusal::duplicate;
    shape<F, n>(local_, *gains_, envelope.sender, t, mailbox_[at]);
    wire::Decoder decoder(body, local_.agents);
    mailbox_[at].visit(decoder);
    evidence_.decode(decoder, at, neighbour, envelope.round == 0 && sensed<F, n>(mailbox_[at]) != nullptr);
    if (decoder.end() == Refusal::none) mail_.put(at, t);
    return decoder.end();
  }

  bool has(int sender) const noexcept override {
    const std::size_t neighbour = mail_.neighbour_of(sender);
    if (neighbour == part_.neighbours.size() || round_ >= rounds_) return false;
    return mail_.has(mail_.place(t_, round_, neighbour), t_);
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
    if (evidence_) evidence_->begin(t, silence_.data(), nullptr);
    return Refusal::none;
  }
  Refusal join(bool speak) noexcept override {
    if (!listening_) return Refusal::order;
    const Inbox<Message> heard = rounds_ > 0 ? inbox() : nobody();
    F::template rejoin<n>(local_, *gains_, heard, t_, state_);
    if (evidence_) {
      if (rounds_ > 0) hear_evidence();
      evidence_->end_sample();
    }
    uncover();
    round_ = rounds_;
    listening_ = false;
    fresh_ = !speak && unheard(heard);
    return Refusal::none;
  }
  void uncover() noexcept override { garrison::uncover<F, n>(*gains_, state_); }

  Report report() const noexcept override {
    Report found = F::template report<n>(local_, *gains_, state_);
    if (plant_.varying()) {
      found.bound = kNaN;
      found.kind = CertificateKind::varying;
      return found;
    }
    const Vec<n>& x = F::template estimate<n>(state_);
    const Bound bound = certificate::least(found.bound, found.kind, evidence_.get(),
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
  void box(std::span<double> out) const noexcept override {
    const Vec<n>& x = F::template estimate<n>(state_);
    const std::span<const double> estimate(x.data(), static_cast<std::size_t>(x.size()));
    certificate::least_box(report().bound, evidence_.get(), estimate, out.first(estimate.size()));
  }
  std::vector<int> proved() const override {
    if (!evidence_) return {};
    const auto found = evidence_.get()->proved();
    return {found.begin(), found.end()};
  }
  std::int64_t resets() const noexcept override { return resets_; }

  std::size_t snapshot_bytes() const noexcept override { return snapshot_bytes_; }
  std::size_t save(std::span<std::byte> out) const noexcept override {
    if (round_ < rounds_ || listening_ || out.size() < snapshot_bytes_) return 0;
    const std::span<std::byte> snapshot = out.first(snapshot_bytes_);
    if (written(SnapshotHead::state_in(snapshot)) + SnapshotHead::kAround != snapshot_bytes_) return 0;
    SnapshotHead{local_.id, part_.design, t_, resets_, fresh_}.write(snapshot);
    return snapshot_bytes_;
  }
  Refusal load(std::span<const std::byte> snapshot) noexcept override {
    if (round_ < rounds_ || listening_) return Refusal::order;
    if (snapshot.size() != snapshot_bytes_) return Refusal::size;
    SnapshotHead head{local_.id, part_.design, 0, 0, false};
    if (const Refusal why = head.read(snapshot); why != Refusal::none) return why;
    wire::Reader reader(SnapshotHead::state_in(snapshot), local_.agents, false);
    plant_.constant(part_, local_);
    reader("", state_);
    if (evidence_) reader("certificate", *evidence_.get());
    const bool certified = !evidence_ || (reader.end() == Refusal::none && evidence_->resume(head.t));
    bool sound = certified && usable<n>(F::template estimate<n>(state_));
    if constexpr (requires { F::template sound<n>(state_); }) sound = sound && F::template sound<n>(state_);
    if (reader.end() != Refusal::none || head.t < start() || head.t > kLatest || !sound) {
      // Somebody forged a checksum: nothing of it may stay.
      loaded_ = false;
      Vec<n> zero = Vec<n>::Zero(local_.states);
      F::template init<n>(local_, *gains_, zero, state_, outgoing_);
      if (evidence_) evidence_->reset(t_);
      uncover();
      return Refusal::damaged;
    }
    loaded_ = true;
    t_ = head.t;
    resets_ = head.resets;
    fresh_ = head.fresh;
    mail_.forget();
    return Refusal::none;
  }

  std::vector<wire::FieldInfo> fields(int sender, std::int64_t t) override {
    std::vector<wire::FieldInfo> all;
    Message any = shaped(sender, t);
    wire::list_fields(FieldList(any), local_.agents, all);
    evidence_.list_fields(sender, all);
    return all;
  }

 private:
  static constexpr std::int64_t kLatest = INT64_MAX / 4;

  void set_state(const Vector& x0, std::int64_t t) {
    const Vec<n> x = x0;
    plant_.constant(part_, local_);
    F::template init<n>(local_, *gains_, x, state_, outgoing_);
    loaded_ = false;
    fresh_ = t != start();
    if (fresh_) uncover();
    t_ = t;
    round_ = rounds_;
    listening_ = lost_ = false;
    resets_ = 0;
    if (evidence_) evidence_->reset(t);
    mail_.forget();
  }
  Message shaped(int sender, std::int64_t t) const {
    Message any = outgoing_;
    shape<F, n>(local_, *gains_, sender, t, any);
    return any;
  }
  /// What an agent sends may be the longest message here.
  void look_at(int sender) {
    const std::size_t own = wire::most_bytes(shaped(sender, first_sample<F>()), local_.agents);
    most_bytes_ = std::max(most_bytes_, own + evidence_.most_bytes(sender));
  }

  void begin(std::int64_t t, const double* y) noexcept {
    t_ = t;
    round_ = 0;
    if (plant_.varying()) uncover();  // what a snapshot of now claims rests on no theorem
    if constexpr (follows<F, n>())
      if (plant_.varying() || (loaded_ && may_vary_))
        F::template vary<n>(local_, *gains_, plant_.change(), 0, state_);
    loaded_ = false;
    F::template sense<n>(local_, *gains_, state_, y, t, outgoing_);
    if (evidence_) evidence_->begin(t, y, sensed<F, n>(outgoing_));
    lost_ = fresh_ || !usable<n>(F::template estimate<n>(state_));
    if (rounds_ == 0 && lost_) rejoin(nobody());
  }
  void miss_one() noexcept {
    begin(t_ + 1, silence_.data());
    mail_.close();
    while (round_ < rounds_) fuse_round(opened());
    uncover();
  }
  void fuse_round(const Inbox<Message>& inbox) noexcept {
    F::template fuse<n>(local_, *gains_, state_, inbox, round_, outgoing_);
    if (evidence_) {
      hear_evidence();
      evidence_->end_round(round_);
    }
    if (++round_ == rounds_ && lost_) rejoin(inbox);
  }
  void hear_evidence() noexcept {
    evidence_.hear(round_, mail_.slots(), mail_.senders(),
                   [this](std::uint32_t slot) { return sensed<F, n>(mailbox_[slot]); });
  }
  void rejoin(const Inbox<Message>& inbox) noexcept {
    F::template rejoin<n>(local_, *gains_, inbox, t_, state_);
    resets_ += fresh_ ? 0 : 1;
    fresh_ = fresh_ && unheard(inbox);
  }
  /// Nothing has come from others, though there are some: what an agent started with is still all it knows.
  bool unheard(const Inbox<Message>& inbox) const noexcept {
    return rounds_ > 0 && local_.degree > 0 && inbox.size() == 0;
  }
  static Inbox<Message> nobody() noexcept { return {nullptr, {}, nullptr, 0}; }
  Inbox<Message> inbox() noexcept {
    mail_.open(t_, round_);
    return opened();
  }
  Inbox<Message> opened() const noexcept {
    return {mailbox_.data(), mail_.slots(), mail_.senders().data(), local_.degree};
  }
  Sent send(std::span<std::byte> out) noexcept {
    if (fresh_ || !bounded(outgoing_)) return {};
    const std::size_t own = wire::encode(outgoing_, local_.agents, out.data());
    return {Refusal::none, own + evidence_.encode(round_, rounds_, out.data() + own)};
  }

  /// Writes the state; how many bytes that takes.
  std::size_t written(std::span<std::byte> out) const noexcept {
    wire::Writer writer(out);
    writer("", const_cast<State&>(state_));  // only read
    if (evidence_) writer("certificate", *evidence_.get());
    return writer.used();
  }

  std::shared_ptr<const Gains> gains_;
  AgentPart part_;
  Local local_;
  AgentPlant plant_;
  int rounds_;
  const bool may_vary_ = why_constant<F>(*gains_).empty();
  AgentMail mail_;
  AgentEvidence evidence_;
  State state_;
  Message outgoing_;
  std::vector<Message> mailbox_;
  std::vector<double> silence_;  // measurements of a sample that was missed
  std::size_t most_bytes_ = 0;
  std::size_t snapshot_bytes_ = 0;
  std::int64_t t_ = 0;
  std::int64_t resets_ = 0;
  int round_ = 0;
  bool listening_ = false;
  bool fresh_ = false;   // has just started in a running network: says nothing before it has heard the others
  bool loaded_ = false;  // from a snapshot, whose last sample may have been of another plant
  bool lost_ = false;    // the estimate is of no use, or nobody knows: rejoins after the last round
};

}  // namespace garrison
