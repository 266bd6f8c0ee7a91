// SPDX-License-Identifier: Apache-2.0
// What an outsider throws at a link: replayed, forged, mutated and strangers' datagrams. Seeded.
#pragma once

#include <ctime>
#include <functional>
#include <vector>

#include "garrison/node/peer.hpp"

namespace garrison::node::test {

using Octets = std::vector<std::byte>;

/// SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators).
class Seeded : public Random {
 public:
  explicit Seeded(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() noexcept {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  std::size_t below(std::size_t n) noexcept { return static_cast<std::size_t>(next() % n); }
  double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double signed_unit() noexcept { return 2 * uniform() - 1; }
  Key key() noexcept override {
    Key made;
    for (std::size_t k = 0; k < 4; ++k) wire::store(made.data() + 8 * k, next());
    return made;
  }

 private:
  std::uint64_t state_;
};

/// Two neighbours, 0 and 1, with a session, and the wire between them.
class Pair {
 public:
  static constexpr Micros kStart = 1'000'000'000'000;

  explicit Pair(std::uint64_t seed = 1)
      : random(seed),
        zero_keys(key_pair(random.key())),
        one_keys(key_pair(random.key())),
        zero(end(0, 1)),
        one(end(1, 0)) {
    prologue.fill(std::byte{7});
    zero = end(0, 1);
    one = end(1, 0);
  }
  /// A fresh end, as after a restart.
  Peer end(int own, int other, std::uint64_t boot = 1) const {
    const bool is_zero = own == 0;
    return {own,      other, is_zero ? zero_keys : one_keys, is_zero ? one_keys.open : zero_keys.open,
            prologue, boot};
  }
  Fate give(Peer& to, Bytes in) {
    const auto received = to.receive(in, now, random, plain.data(), reply);
    return received.fate;
  }
  /// Initiation, response and confirmation.
  bool link(Peer& from, Peer& to) {
    Datagram out;
    out.size = 0;
    if (!from.tick(now, random, out)) return false;
    captured.emplace_back(out.view().begin(), out.view().end());
    Peer* receiver = &to;
    Peer* sender = &from;
    while (out.size != 0) {
      if (const Fate f = give(*receiver, out.view()); f != Fate::handshake && f != Fate::taken) return false;
      out = reply;
      if (out.size != 0) captured.emplace_back(out.view().begin(), out.view().end());
      std::swap(receiver, sender);
    }
    return from.up() && to.up();
  }
  Octets frame(Peer& from, std::size_t body = 41) {
    Octets inside(kInner + body);
    for (std::size_t k = kInner; k < inside.size(); ++k) inside[k] = static_cast<std::byte>(random.next());
    Inner{Kind::message, 0, false, 0, 5}.write(inside.data());
    Octets out(kMostDatagram);
    out.resize(from.seal_frame(inside, now.steady, out.data()));
    return out;
  }
  void pass(Micros time) {
    now.wall += time;
    now.steady += time;
  }

  Seeded random;
  KeyPair zero_keys;
  KeyPair one_keys;
  Prologue prologue{};
  Instant now{kStart, 5'000'000};
  Peer zero;
  Peer one;
  std::array<std::byte, kMostDatagram> plain{};
  Datagram reply;
  std::vector<Octets> captured;  ///< of the handshakes
};

struct Outcome {
  std::int64_t tried = 0;
  Fates fates;
  double seconds = 0.0;  ///< CPU
  std::int64_t accepted() const { return fates[Fate::taken] + fates[Fate::handshake]; }
};

/// Gives `count` datagrams to a peer. Timed a thousand at once: reading the clock costs as much as a refusal.
inline Outcome throw_at(Pair& pair, Peer& target, std::int64_t count,
                        const std::function<const Octets&(std::int64_t)>& make) {
  Outcome outcome;
  std::vector<Octets> batch;
  while (outcome.tried < count) {
    batch.clear();
    for (; outcome.tried < count && batch.size() < 1000; ++outcome.tried)
      batch.push_back(make(outcome.tried));
    const std::clock_t before = std::clock();
    for (const Octets& bytes : batch) outcome.fates.count(pair.give(target, bytes));
    outcome.seconds += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  }
  return outcome;
}

/// One bit, the length, the counter, a header field or everything: never the datagram itself. Frames that
/// were never delivered, so that nothing but the tag speaks against them.
inline Octets mutated(const Octets& genuine, Seeded& random) {
  Octets bytes = genuine;
  while (bytes == genuine) {
    switch (random.below(5)) {
      case 0:
        bytes[random.below(bytes.size())] ^= static_cast<std::byte>(1U << random.below(8));
        break;
      case 1:
        bytes.resize(random.below(kMostDatagram + 20));
        break;
      case 2:
        wire::store(bytes.data() + 8, random.next());
        break;
      case 3:
        bytes[random.below(kOuter)] = static_cast<std::byte>(random.next());
        break;
      default:
        for (std::size_t k = kOuter; k < bytes.size(); ++k) bytes[k] = static_cast<std::byte>(random.next());
    }
    if (bytes.size() < 16) return bytes;
  }
  return bytes;
}

}  // namespace garrison::node::test
