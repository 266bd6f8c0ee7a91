// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/peer.hpp"

#include <doctest/doctest.h>

#include "hostile.hpp"

using namespace garrison::node;
using namespace garrison::node::test;

TEST_CASE("counters are taken once, in a window behind the greatest") {
  Window window;
  CHECK_FALSE(window.fresh(0));
  for (const std::uint64_t c : {1U, 3U, 2U, 2000U, 977U}) {
    CHECK(window.fresh(c));
    window.mark(c);
    CHECK_FALSE(window.fresh(c));
  }
  CHECK_FALSE(window.fresh(976));  // too old to tell
  CHECK(window.fresh(1999));
  window.mark(3024);
  CHECK_FALSE(window.fresh(2000));
  CHECK(window.fresh(2001));
}

TEST_CASE("a link opens, carries frames both ways and each once") {
  Pair pair;
  REQUIRE(pair.link(pair.zero, pair.one));
  for (int k = 0; k < 3; ++k) {
    const Octets there = pair.frame(pair.zero);
    CHECK(pair.give(pair.one, there) == Fate::taken);
    CHECK(pair.give(pair.one, there) == Fate::replay);
    const Octets back = pair.frame(pair.one);
    CHECK(pair.give(pair.zero, back) == Fate::taken);
    CHECK(pair.give(pair.one, back) == Fate::stranger);  // reflected
  }
}

TEST_CASE("the responder uses new keys once the initiator has") {
  Pair pair;
  Datagram first, second;
  REQUIRE(pair.zero.tick(pair.now, pair.random, first));
  CHECK(pair.give(pair.one, first.view()) == Fate::handshake);
  CHECK_FALSE(pair.one.up());
  second = pair.reply;
  CHECK(pair.give(pair.zero, second.view()) == Fate::handshake);
  CHECK(pair.zero.up());
  CHECK(pair.give(pair.one, pair.reply.view()) == Fate::taken);
  CHECK(pair.one.up());
}

TEST_CASE("both start at once: one link comes of it") {
  Pair pair;
  Datagram from_zero, from_one;
  REQUIRE(pair.zero.tick(pair.now, pair.random, from_zero));
  REQUIRE(pair.one.tick(pair.now, pair.random, from_one));
  CHECK(pair.give(pair.zero, from_one.view()) == Fate::busy);
  CHECK(pair.give(pair.one, from_zero.view()) == Fate::handshake);
  const Datagram response = pair.reply;
  CHECK(pair.give(pair.zero, response.view()) == Fate::handshake);
  CHECK(pair.give(pair.one, pair.reply.view()) == Fate::taken);
  CHECK(pair.zero.up());
  CHECK(pair.one.up());
}

TEST_CASE("a session is renewed after its time, and the one before is heard a little longer") {
  Pair pair;
  REQUIRE(pair.link(pair.zero, pair.one));
  const Octets under_way = pair.frame(pair.one);
  const Octets too_late = pair.frame(pair.one);
  pair.pass(Peer::kSessionTime - 1000);
  CHECK(pair.give(pair.zero, pair.frame(pair.one)) == Fate::taken);  // heard, so nothing is doubted
  pair.pass(1000);
  REQUIRE(pair.link(pair.zero, pair.one));
  CHECK(pair.give(pair.zero, under_way) == Fate::taken);
  pair.pass(Peer::kPrevious);
  CHECK(pair.give(pair.zero, too_late) == Fate::no_session);
  CHECK(pair.give(pair.zero, pair.frame(pair.one)) == Fate::taken);
}

TEST_CASE("a silent link says that it is alive; one that hears nothing is opened again") {
  Pair pair;
  REQUIRE(pair.link(pair.zero, pair.one));
  Datagram out;
  CHECK_FALSE(pair.zero.tick(pair.now, pair.random, out));
  pair.pass(Peer::kAlive);
  REQUIRE(pair.zero.tick(pair.now, pair.random, out));
  CHECK(pair.give(pair.one, out.view()) == Fate::taken);
  pair.pass(Peer::kSilence);
  REQUIRE(pair.zero.tick(pair.now, pair.random, out));
  CHECK(out.size == kInitiation);
}

TEST_CASE("a restarted node is back with its first initiation, whatever its clock says") {
  Pair pair;
  REQUIRE(pair.link(pair.zero, pair.one));
  pair.pass(1000);
  Peer again = pair.end(0, 1, 2);
  REQUIRE(pair.link(again, pair.one));
  CHECK(pair.one.boot_of_peer() == 2);
  Peer wrong_clock = pair.end(0, 1, 3);
  pair.now.wall -= 3'600'000'000;  // its clock went back an hour
  CHECK_FALSE(pair.link(wrong_clock, pair.one));
  pair.now.steady += Peer::kSilence;
  CHECK(pair.link(wrong_clock, pair.one));
}

TEST_CASE("replayed initiations: the last one never, older ones on a silent link and once a second") {
  Pair pair;
  REQUIRE(pair.link(pair.zero, pair.one));
  const Octets first = pair.captured[0];
  CHECK(pair.give(pair.one, first) == Fate::stale);
  pair.pass(Peer::kSilence);
  REQUIRE(pair.link(pair.zero, pair.one));
  CHECK(pair.give(pair.one, first) == Fate::stale);
  pair.pass(Peer::kSilence - 1);
  CHECK(pair.give(pair.one, first) == Fate::stale);
  pair.pass(1);
  CHECK(pair.give(pair.one, first) == Fate::handshake);
  CHECK(pair.give(pair.one, first) == Fate::stale);
  CHECK(pair.give(pair.one, pair.frame(pair.zero)) == Fate::taken);  // the session is untouched
}

TEST_CASE("nodes of another design or run do not link up") {
  Pair pair;
  Pair other;
  other.prologue[40] ^= std::byte{1};
  Peer foreign = other.end(0, 1);
  Datagram out;
  REQUIRE(foreign.tick(pair.now, pair.random, out));
  CHECK(pair.give(pair.one, out.view()) == Fate::tag);
}

// Rows 1 to 5 of the acceptance table at reduced counts; garrison_node_hostile has the full ones.
TEST_CASE("outsiders: nothing is taken, everything is counted by name") {
  Pair pair(3);
  REQUIRE(pair.link(pair.zero, pair.one));
  std::vector<Octets> genuine;
  for (int k = 0; k < 2000; ++k) {
    genuine.push_back(pair.frame(pair.zero));
    REQUIRE(pair.give(pair.one, genuine.back()) == Fate::taken);
  }
  const auto all = static_cast<std::int64_t>(genuine.size());
  const auto replay = [&](std::int64_t k) -> const Octets& { return genuine[static_cast<std::size_t>(k)]; };
  SUBCASE("replayed at once") { CHECK(throw_at(pair, pair.one, all, replay).fates[Fate::replay] == all); }
  SUBCASE("replayed to a restarted receiver, with the handshake") {
    Peer restarted = pair.end(1, 0, 2);
    for (const Octets& bytes : pair.captured) pair.give(restarted, bytes);
    CHECK(throw_at(pair, restarted, all, replay).accepted() == 0);
    CHECK_FALSE(restarted.up());
  }
  SUBCASE("forged") {
    Octets bytes;
    const auto outcome = throw_at(pair, pair.one, 20000, [&](std::int64_t k) -> const Octets& {
      bytes = genuine[static_cast<std::size_t>(k) % genuine.size()];
      garrison::wire::store(bytes.data() + 8, std::uint64_t{3000} + pair.random.below(1000000));
      for (std::size_t b = kOuter; b < bytes.size(); ++b)
        bytes[b] = static_cast<std::byte>(pair.random.next());
      return bytes;
    });
    CHECK(outcome.fates[Fate::tag] == outcome.tried);
  }
  SUBCASE("mutated") {
    Octets bytes;
    const Octets unused = pair.frame(pair.zero);
    const auto outcome = throw_at(pair, pair.one, 20000, [&](std::int64_t) -> const Octets& {
      bytes = mutated(unused, pair.random);
      return bytes;
    });
    CHECK(outcome.accepted() == 0);
    CHECK(outcome.fates.refused() == outcome.tried);
    CHECK(pair.give(pair.one, unused) == Fate::taken);
  }
  SUBCASE("strangers' handshakes") {
    Pair stranger(4);
    Peer unknown = stranger.end(0, 1);
    Octets bytes;
    const auto outcome = throw_at(pair, pair.one, 200, [&](std::int64_t) -> const Octets& {
      Datagram out;
      stranger.pass(Peer::kRetry);
      unknown.tick(stranger.now, stranger.random, out);
      bytes.assign(out.view().begin(), out.view().end());
      return bytes;
    });
    CHECK(outcome.fates[Fate::tag] == outcome.tried);
  }
  CHECK(pair.give(pair.one, pair.frame(pair.zero)) == Fate::taken);  // the link still works
}

// A link that stayed deaf one way while the clock of one end was wrong (seed 2114): new handshakes had older
// stamps, and the other end, which heard, saw no reason to take them.
TEST_CASE("a session that the neighbour has dropped gives way to the one that is heard") {
  Pair pair;
  REQUIRE(pair.link(pair.zero, pair.one));
  Datagram out;
  for (int handshakes = 0; handshakes < 2; ++handshakes) {
    pair.pass(Peer::kSilence + 100'000);
    REQUIRE(pair.one.tick(pair.now, pair.random, out));
    REQUIRE(pair.give(pair.zero, out.view()) == Fate::handshake);
    // The first response arrives, but not what confirms it; the second one does not arrive.
    if (handshakes == 0) REQUIRE(pair.give(pair.one, pair.reply.view()) == Fate::handshake);
  }
  CHECK(pair.give(pair.zero, pair.frame(pair.one)) == Fate::no_session);
  CHECK(pair.give(pair.one, pair.frame(pair.zero)) == Fate::taken);
  CHECK(pair.give(pair.zero, pair.frame(pair.one)) == Fate::taken);
}
