// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/peer.hpp"

#include <utility>

namespace garrison::node {

namespace {
constexpr std::size_t kStamp = 4;          // where an initiation's stamp lies
constexpr std::size_t kNoiseFirst = 12;    // and its Noise message
constexpr std::size_t kNoiseSecond = 8;    // the response's
constexpr std::size_t kFirstPayload = 20;  // boot u64, clock i64, index u32
constexpr std::size_t kSecondPayload = 4;  // index u32
static_assert(kNoiseFirst + 32 + kFirstPayload + kTag + kMac == kInitiation);
static_assert(kNoiseSecond + 32 + kSecondPayload + kTag + kMac == kResponse);
}  // namespace

Peer::Peer(int own_id, int id, const KeyPair& own, const Key& theirs, const Prologue& prologue,
           std::uint64_t boot)
    : own_id_(own_id), id_(id), own_(own), theirs_(theirs), prologue_(prologue), boot_(boot) {
  Key secret{};
  shared_secret(own.secret, theirs, secret);
  hash(secret, {text_bytes("garrison handshake mac")}, door_);
  wipe(secret);
}

bool Peer::tick(Instant now, Random& random, Datagram& out) noexcept {
  const Session& s = current_;
  const bool old =
      s.live && s.started_here && (s.sent >= kSessionFrames || now.steady - s.since >= kSessionTime);
  const bool doubted = !s.live || now.steady - heard_ >= kSilence;
  if ((old || doubted) && now.steady >= retry_at_) {
    retry_at_ = now.steady + (s.live ? kRetryLive : kRetry);
    initiate(now, random, out);
    return out.size != 0;
  }
  if (!s.live || now.steady - spoken_ < kAlive) return false;
  alive(now.steady, out);
  return true;
}

Peer::Received Peer::receive(Bytes in, Instant now, Random& random, std::byte* plain,
                             Datagram& reply) noexcept {
  reply.size = 0;
  if (in.size() < 4 || in.size() > kMostDatagram) return {Fate::size};
  if (wire::load<std::uint8_t>(in.data() + 1) != kWireVersion) return {Fate::version};
  if (sender_of(in) != id_) return {Fate::stranger};
  switch (static_cast<Type>(wire::load<std::uint8_t>(in.data()))) {
    case Type::initiation:
      return {initiation(in, now, random, reply)};
    case Type::response:
      return {response(in, now.steady, reply)};
    case Type::data:
      return data(in, now.steady, plain);
  }
  return {Fate::type};
}

std::size_t Peer::seal_frame(Bytes plain, Micros steady, std::byte* out) noexcept {
  Session& s = current_;
  write_head(out, Type::data, own_id_);
  wire::store(out + 4, s.theirs);
  wire::store(out + 8, ++s.sent);
  spoken_ = steady;
  return kOuter + seal(s.sending, s.sent, {out, kOuter}, plain, out + kOuter);
}

void Peer::initiate(Instant now, Random& random, Datagram& out) noexcept {
  out.size = 0;
  const Key ephemeral = random.key();
  index_ = wire::load<std::uint32_t>(random.key().data());
  handshake_ = Handshake(Handshake::Role::initiator, prologue_, own_, theirs_);
  std::byte* at = out.bytes.data();
  write_head(at, Type::initiation, own_id_);
  wire::store(at + kStamp, static_cast<std::uint64_t>(now.wall));
  std::array<std::byte, kFirstPayload> payload;
  wire::store(payload.data(), boot_);
  wire::store(payload.data() + 8, static_cast<std::uint64_t>(now.wall));
  wire::store(payload.data() + 16, index_);
  waiting_ = handshake_.write(payload, ephemeral, at + kNoiseFirst);
  if (!waiting_) return;
  asked_ = now.steady;
  put_mac(at, kInitiation - kMac);
  out.size = kInitiation;
}

Fate Peer::initiation(Bytes in, Instant now, Random& random, Datagram& reply) noexcept {
  if (in.size() != kInitiation) return Fate::size;
  if (!mac_fits(in)) return Fate::tag;
  // A stamp that is not newer is a replay, or their clock went back. It is taken on a silent link only, once
  // a second, and the very last one never: replays do not disturb a link that works.
  const auto stamp = static_cast<std::int64_t>(wire::load<std::uint64_t>(in.data() + kStamp));
  const bool works = current_.live && now.steady - heard_ < kSilence;
  const bool under_way = next_.live && now.steady - next_.since < kRetryLive;
  const bool old_is_welcome = !works && !under_way && now.steady >= old_stamp_from_;
  if (stamp == last_stamp_ || (stamp < last_stamp_ && !old_is_welcome)) return Fate::stale;
  // Both started at once: the lower id's handshake is the one.
  if (waiting_ && own_id_ < id_ && now.steady - asked_ < kRetry) return Fate::busy;
  old_stamp_from_ = now.steady + 1'000'000;
  Handshake answer(Handshake::Role::responder, prologue_, own_, theirs_);
  std::array<std::byte, kFirstPayload> payload;
  if (!answer.read(in.subspan(kNoiseFirst, 32 + kFirstPayload + kTag), payload.data())) return Fate::tag;
  last_stamp_ = stamp;
  their_boot_ = wire::load<std::uint64_t>(payload.data());
  waiting_ = false;

  next_ = Session{};
  next_.ours = wire::load<std::uint32_t>(random.key().data());
  next_.theirs = wire::load<std::uint32_t>(payload.data() + 16);
  std::byte* at = reply.bytes.data();
  write_head(at, Type::response, own_id_);
  wire::store(at + 4, next_.theirs);
  std::array<std::byte, kSecondPayload> index;
  wire::store(index.data(), next_.ours);
  if (!answer.write(index, random.key(), at + kNoiseSecond)) return Fate::tag;
  put_mac(at, kResponse - kMac);
  answer.split(next_.sending, next_.receiving);
  next_.live = true;
  next_.since = now.steady;
  reply.size = kResponse;
  return Fate::handshake;
}

Fate Peer::response(Bytes in, Micros steady, Datagram& reply) noexcept {
  if (in.size() != kResponse) return Fate::size;
  if (!mac_fits(in)) return Fate::tag;
  if (!waiting_ || wire::load<std::uint32_t>(in.data() + 4) != index_) return Fate::no_session;
  Handshake finished = handshake_;  // a forged one must not spoil ours
  std::array<std::byte, kSecondPayload> index;
  if (!finished.read(in.subspan(kNoiseSecond, 32 + kSecondPayload + kTag), index.data())) return Fate::tag;
  waiting_ = false;
  Session made;
  made.ours = index_;
  made.theirs = wire::load<std::uint32_t>(index.data());
  finished.split(made.sending, made.receiving);
  made.live = made.started_here = true;
  made.since = steady;
  use(made, steady);
  heard_ = steady;
  alive(steady, reply);  // they use the keys once we do
  return Fate::handshake;
}

Peer::Received Peer::data(Bytes in, Micros steady, std::byte* plain) noexcept {
  if (in.size() < kLeastData) return {Fate::size};
  const auto index = wire::load<std::uint32_t>(in.data() + 4);
  const auto counter = wire::load<std::uint64_t>(in.data() + 8);
  if (previous_.live && steady >= previous_until_) previous_ = Session{};
  for (Session* s : {&current_, &next_, &previous_}) {
    if (!s->live || s->ours != index) continue;
    if (!s->window.fresh(counter)) return {Fate::replay};
    if (!open(s->receiving, counter, in.first(kOuter), in.subspan(kOuter), plain)) return {Fate::tag};
    s->window.mark(counter);
    heard_ = steady;
    s->heard = steady;
    if (s == &previous_) keep_previous(steady);
    if (s == &next_) {
      const Session confirmed = next_;
      next_ = Session{};
      use(confirmed, steady);
    }
    return {Fate::taken, in.size() - kOuter - kTag};
  }
  return {Fate::no_session};
}

void Peer::alive(Micros steady, Datagram& out) noexcept {
  std::array<std::byte, kInner> plain;
  Inner{}.write(plain.data());
  out.size = seal_frame(plain, steady, out.bytes.data());
}

void Peer::use(const Session& next, Micros steady) noexcept {
  previous_ = current_;
  previous_until_ = steady + kPrevious;
  current_ = next;
  current_.heard = steady;
}

/// Handshakes that crossed may leave us with different ones of two sessions: what is heard stays. Where
/// nothing at all comes in the newer one, the neighbour has dropped it, and hears us in the older one only.
void Peer::keep_previous(Micros steady) noexcept {
  previous_until_ = steady + kPrevious;
  if (steady - current_.heard >= kSilence) std::swap(current_, previous_);
}

void Peer::put_mac(std::byte* at, std::size_t before) const noexcept {
  hash(door_, {Bytes{at, before}}, {at + before, kMac});
}
bool Peer::mac_fits(Bytes in) const noexcept {
  std::array<std::byte, kMac> mac;
  hash(door_, {in.first(in.size() - kMac)}, mac);
  return same(mac, in.last(kMac));
}

}  // namespace garrison::node
