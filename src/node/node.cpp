// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/node.hpp"

#include <limits>

namespace garrison::node {

namespace {
constexpr int kMostHops = 2;  // that a statement is passed on
constexpr int kChecks = 256;  // of signatures, in a sample: they cost more than anything else that arrives

/// Microseconds that fit a frame's field; beyond half an hour the clocks are wrong anyway.
std::int32_t narrow(Micros time) noexcept {
  return static_cast<std::int32_t>(std::clamp<Micros>(time, -2'000'000'000, 2'000'000'000));
}
std::uint64_t mark_of(Bytes body) noexcept {
  std::array<std::byte, 16> digest;
  hash({}, {body}, digest);
  return wire::load<std::uint64_t>(digest.data());
}
}  // namespace

Node::Node(Agent& agent, const Schedule& schedule, const KeyPair& own, std::vector<Neighbour> neighbours,
           const Prologue& prologue, std::uint64_t boot, World& world, Random& random)
    : schedule_(schedule), world_(world), random_(random), core_(agent, schedule, *this) {
  std::sort(neighbours.begin(), neighbours.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  links_.reserve(neighbours.size());
  for (const Neighbour& n : neighbours) {
    links_.push_back({Peer(agent.id(), n.id, own, n.key, prologue, boot), n.listens, {}});
    if (agent.most_bytes() > kFragment) links_.back().parts.resize(agent.most_bytes());
  }
}

void Node::tick(Instant now) noexcept {
  now_ = now;
  for (Link& link : links_)
    if (link.peer.tick(now, random_, out_)) world_.send(link.peer.id(), out_.view());
  core_.tick(now);
}

Micros Node::due() const noexcept { return core_.due(); }

Fate Node::receive(Bytes datagram, Instant now) noexcept {
  now_ = now;
  const bool sized = datagram.size() >= 4 && datagram.size() <= kMostDatagram;
  Link* link = sized ? link_of(sender_of(datagram)) : nullptr;
  if (link == nullptr) {
    const Fate fate = sized ? Fate::stranger : Fate::size;
    outside_.count(fate);
    return fate;
  }
  const Peer::Received received = link->peer.receive(datagram, now, random_, plain_.data(), out_);
  if (out_.size != 0) world_.send(link->peer.id(), out_.view());
  Fate fate = received.fate;
  if (fate == Fate::taken) fate = frame(*link, {plain_.data(), received.plain}, now);
  link->fates.count(fate);
  return fate;
}

LinkView Node::link(std::size_t k, Instant now) const noexcept {
  const Link& link = links_[k];
  LinkView view = link.view;
  view.id = link.peer.id();
  view.up = link.peer.up();
  view.absent = core_.absent(view.id);
  view.age = link.peer.heard() == 0 ? -1 : now.steady - link.peer.heard();
  return view;
}

void Node::broadcast(std::int64_t sample, int round, Bytes body) noexcept {
  for (Link& link : links_)
    if (link.listens) send_body(link, sample, round, body);
  Statement signed_now;
  if (authors_ != nullptr && authors_->said(sample, round, body, signed_now))
    spread(signed_now, sample, 0, -1);
}
void Node::answer(int neighbour, std::int64_t sample, int round, Bytes body) noexcept {
  Link* link = link_of(neighbour);
  if (link != nullptr && link->listens) send_body(*link, sample, round, body);
}
void Node::want(int neighbour, std::int64_t sample, int round) noexcept {
  Inner inner{Kind::want, 0, false, static_cast<std::uint16_t>(round), sample};
  if (Link* link = link_of(neighbour); link != nullptr) send_frame(*link, inner, {});
}

void Node::ended(const Sample& sample) noexcept {
  checks_left_ = kChecks;
  world_.ended(sample);
}

Node::Link* Node::link_of(int id) noexcept {
  const auto at = std::lower_bound(links_.begin(), links_.end(), id,
                                   [](const Link& link, int wanted) { return link.peer.id() < wanted; });
  return at != links_.end() && at->peer.id() == id ? &*at : nullptr;
}

void Node::send_body(Link& link, std::int64_t sample, int round, Bytes body) noexcept {
  Inner inner{Kind::message, 0, false, static_cast<std::uint16_t>(round), sample};
  while (body.size() > kFragment) {
    inner.more = true;
    send_frame(link, inner, body.first(kFragment));
    body = body.subspan(kFragment);
    ++inner.fragment;
  }
  inner.more = false;
  send_frame(link, inner, body);
}

void Node::send_frame(Link& link, Inner inner, Bytes rest) noexcept {
  if (!link.peer.up()) return;
  inner.phase = narrow(now_.wall - schedule_.begin(inner.sample));
  inner.echo = link.echo;
  std::array<std::byte, kInner + kFragment> plain;
  inner.write(plain.data());
  copy(rest, plain.data() + kInner);
  std::size_t size = kInner + rest.size();
  if (tamper_ != nullptr) size = (*tamper_)(link.peer.id(), plain, size);
  Datagram sealed;
  sealed.size = link.peer.seal_frame({plain.data(), size}, now_.steady, sealed.bytes.data());
  world_.send(link.peer.id(), sealed.view());
}

Fate Node::frame(Link& link, Bytes plain, Instant now) noexcept {
  const Inner inner = Inner::read(plain.data());
  const Bytes rest = plain.subspan(kInner);
  core_.contact(link.peer.id(), now);
  switch (inner.kind) {
    case Kind::message: {
      const Fate fate = message(link, inner, rest, now);
      if (fate == Fate::taken) time_link(link, inner, now);  // of a sample that exists
      return fate;
    }
    case Kind::statement:
      return statement(link, inner, rest);
    case Kind::want:
      return rest.empty() ? core_.wanted(link.peer.id(), inner.sample, inner.round) : Fate::kind;
    case Kind::alive:
      return rest.empty() ? Fate::taken : Fate::kind;
    default:
      return Fate::kind;
  }
}

/// Fragments come in order or are asked for again: what is out of order is dropped.
Fate Node::message(Link& link, const Inner& inner, Bytes part, Instant now) noexcept {
  const bool whole = inner.fragment == 0 && !inner.more;
  if (whole) return body(link, inner, part, now);
  if (link.parts.empty() || (inner.more && part.size() != kFragment)) return Fate::kind;
  if (inner.fragment == 0) {
    link.building = inner;
    link.filled = 0;
  }
  const bool next = link.building.sample == inner.sample && link.building.round == inner.round &&
                    link.filled == inner.fragment * kFragment;
  if (!next || link.filled + part.size() > link.parts.size()) return Fate::kind;
  copy(part, link.parts.data() + link.filled);
  link.filled += part.size();
  if (inner.more) return Fate::taken;
  const Bytes all(link.parts.data(), link.filled);
  link.filled = 0;
  return body(link, inner, all, now);
}

Fate Node::body(Link& link, const Inner& inner, Bytes body, Instant now) noexcept {
  const Fate fate = core_.message(link.peer.id(), inner.sample, inner.round, body, mark_of(body), now);
  if (fate == Fate::taken && authors_ != nullptr)
    authors_->heard(link.peer.id(), inner.sample, inner.round, body);
  return fate;
}

/// New ones go on to all others, so that those who were told something else see both.
Fate Node::statement(Link& link, const Inner& inner, Bytes rest) noexcept {
  if (authors_ == nullptr) return Fate::off;
  const auto said = Statement::read(rest);
  if (!said) return Fate::kind;
  if (checks_left_ <= 0) return Fate::off;
  --checks_left_;
  Statement other;
  const Authors::News news = authors_->take(*said, other);
  if (news == Authors::News::known) return Fate::duplicate;
  if (news == Authors::News::refused) return Fate::kind;
  if (news == Authors::News::contradiction) {
    world_.contradiction(other, *said);
    spread(other, inner.sample, inner.round + 1, link.peer.id());  // the other half, whoever missed it
  }
  if (inner.round < kMostHops) spread(*said, inner.sample, inner.round + 1, link.peer.id());
  return Fate::taken;
}

void Node::spread(const Statement& statement, std::int64_t sample, int hops, int but) noexcept {
  std::array<std::byte, Statement::kSize> bytes;
  statement.write(bytes.data());
  const Inner inner{Kind::statement, 0, false, static_cast<std::uint16_t>(hops), sample};
  for (Link& link : links_)
    if (link.peer.id() != but) send_frame(link, inner, bytes);
}

/// With d the difference of the phases one way and e the other way round, the clocks differ by (e - d)/2 and
/// the link takes (d + e)/2, if it takes as long in both directions.
void Node::time_link(Link& link, const Inner& inner, Instant now) noexcept {
  const Micros there = now.wall - schedule_.begin(inner.sample) - inner.phase;
  link.echo = narrow(there);
  if (inner.echo == Inner::kNoEcho) return;
  link.view.skew = (inner.echo - there) / 2;
  link.view.delay = (inner.echo + there) / 2;
  link.view.timed = true;
}

}  // namespace garrison::node
