// SPDX-License-Identifier: Apache-2.0
// The published vector of Noise_KK_25519_ChaChaPoly_SHA256 (cacophony, as the implementation snow carries
// it).
#include "garrison/node/noise.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "garrison/node/frame.hpp"

using namespace garrison::node;

namespace {
using Octets = std::vector<std::byte>;

Octets hex(const std::string& digits) {
  Octets all;
  for (std::size_t k = 0; k < digits.size(); k += 2)
    all.push_back(static_cast<std::byte>(std::stoi(digits.substr(k, 2), nullptr, 16)));
  return all;
}
Key key(const std::string& digits) {
  Key made;
  copy(hex(digits), made.data());
  return made;
}

struct Both {
  KeyPair initiator = key_pair(key("e61ef9919cde45dd5f82166404bd08e38bceb5dfdfded0a34c8df7ed542214d1"));
  KeyPair responder = key_pair(key("4a3acbfdb163dec651dfa3194dece676d437029c62a408b4c5ea9114246e4893"));
  Key first = key("893e28b9dc6ca8d611ab664754b8ceb7bac5117349a4439a6b0569da977c464a");
  Key second = key("bbdb4cdbd309f1a1f2e1456967fe288cadd6f712d65dc7b7793d5e63da6b375b");
  Octets prologue = hex("4a6f686e2047616c74");
  Handshake i{Handshake::Role::initiator, prologue, initiator, responder.open};
  Handshake r{Handshake::Role::responder, prologue, responder, initiator.open};

  Octets message(Handshake& from, const std::string& payload, const Key& ephemeral) const {
    const Octets plain = hex(payload);
    Octets out(48 + plain.size());
    REQUIRE(from.write(plain, ephemeral, out.data()));
    return out;
  }
};

Octets sealed(const Key& with, const std::string& plain) {
  const Octets bytes = hex(plain);
  Octets out(bytes.size() + kTag);
  seal(with, 0, {}, bytes, out.data());
  return out;
}
}  // namespace

TEST_CASE("the published Noise_KK vector") {
  Both both;
  Octets payload(16);
  const Octets first = both.message(both.i, "4c756477696720766f6e204d69736573", both.first);
  CHECK(first ==
        hex("ca35def5ae56cec33dc2036731ab14896bc4c75dbb07a61f879f8e3afa4c79440177015efc1fe7a37c629af7120a9627"
            "4e6ab7afcc9261901d0e09ae32a5bb96"));
  CHECK(both.r.read(first, payload.data()));
  CHECK(payload == hex("4c756477696720766f6e204d69736573"));

  const Octets second = both.message(both.r, "4d757272617920526f746862617264", both.second);
  CHECK(second ==
        hex("95ebc60d2b1fa672c1f46a8aa265ef51bfe38e7ccb39ec5be34069f144808843b274d3429adc47ca093ba63ef90f8da8"
            "9fda108db471dccfa4894aa7b00003"));
  payload.resize(15);
  CHECK(both.i.read(second, payload.data()));
  CHECK(payload == hex("4d757272617920526f746862617264"));

  CHECK(both.i.transcript() == key("24c6b51ecb76277140ca018b5985bc9f03de321dae2d34dcae433dafef0131d9"));
  CHECK(both.r.transcript() == both.i.transcript());
  Key from_i, to_i, from_r, to_r;
  both.i.split(from_i, to_i);
  both.r.split(from_r, to_r);
  CHECK(from_i == to_r);
  CHECK(from_r == to_i);
  CHECK(sealed(from_i, "462e20412e20486179656b") ==
        hex("966b05bc69ec01b8454d3160a214e6f24a3d884eb31ec2408af63f"));
  CHECK(sealed(from_r, "4361726c204d656e676572") ==
        hex("0ad887fba4f611bbb4afe44ba3556b8164332ca7d5934634d63d80"));
}

TEST_CASE("another prologue, another key or a changed byte is refused") {
  Both both;
  const Octets first = both.message(both.i, "00", both.first);
  Octets payload(1);
  Handshake other(Handshake::Role::responder, hex("00"), both.responder, both.initiator.open);
  CHECK_FALSE(other.read(first, payload.data()));
  Handshake stranger(Handshake::Role::responder, both.prologue, both.responder, both.responder.open);
  CHECK_FALSE(stranger.read(first, payload.data()));
  for (std::size_t k = 0; k < first.size(); ++k) {
    Octets changed = first;
    changed[k] ^= std::byte{1};
    Handshake fresh(Handshake::Role::responder, both.prologue, both.responder, both.initiator.open);
    CHECK_FALSE(fresh.read(changed, payload.data()));
  }
  CHECK_FALSE(both.r.read(Octets(47), payload.data()));
}

TEST_CASE("a key of small order makes no shared secret") {
  Both both;
  Handshake weak(Handshake::Role::initiator, both.prologue, both.initiator, Key{});
  Octets out(48);
  CHECK_FALSE(weak.write({}, both.first, out.data()));
}
