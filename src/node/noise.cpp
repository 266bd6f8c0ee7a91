// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/noise.hpp"

#include <sodium.h>

#include "garrison/node/frame.hpp"
#include "node/octets.hpp"

namespace garrison::node {

namespace {
/// HMAC-SHA256 of data | last (unless 0).
void hmac(const Key& key, Bytes data, unsigned char last, Key& out) noexcept {
  crypto_auth_hmacsha256_state state;
  crypto_auth_hmacsha256_init(&state, octets(key), key.size());
  crypto_auth_hmacsha256_update(&state, octets(data), data.size());
  if (last != 0) crypto_auth_hmacsha256_update(&state, &last, 1);
  crypto_auth_hmacsha256_final(&state, octets(out));
}
}  // namespace

Handshake::Handshake(Role role, Bytes prologue, const KeyPair& own, const Key& theirs) noexcept
    : role_(role), s_(own), rs_(theirs) {
  copy(text_bytes("Noise_KK_25519_ChaChaPoly_SHA256"), h_.data());  // 32 letters: the hash is the name
  ck_ = h_;
  mix_hash(prologue);
  mix_hash(role == Role::initiator ? s_.open : rs_);
  mix_hash(role == Role::initiator ? rs_ : s_.open);
}

bool Handshake::write(Bytes payload, const Key& ephemeral, std::byte* out) noexcept {
  e_ = key_pair(ephemeral);
  copy(e_.open, out);
  mix_hash(e_.open);
  const bool mixed = role_ == Role::initiator ? mix(e_, rs_) && mix(s_, rs_) : mix(e_, re_) && mix(e_, rs_);
  if (!mixed) return false;
  const std::size_t sealed = seal(k_, 0, h_, payload, out + 32);
  mix_hash({out + 32, sealed});
  return true;
}

bool Handshake::read(Bytes message, std::byte* payload) noexcept {
  if (message.size() < 32 + kTag) return false;
  copy(message.first(32), re_.data());
  mix_hash(re_);
  const bool mixed = role_ == Role::initiator ? mix(e_, re_) && mix(s_, re_) : mix(s_, re_) && mix(s_, rs_);
  const Bytes sealed = message.subspan(32);
  if (!mixed || !open(k_, 0, h_, sealed, payload)) return false;
  mix_hash(sealed);
  return true;
}

void Handshake::split(Key& sending, Key& receiving) noexcept {
  if (role_ == Role::initiator)
    mix_key({}, sending, receiving);
  else
    mix_key({}, receiving, sending);
}

void Handshake::mix_hash(Bytes data) noexcept {
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  crypto_hash_sha256_update(&state, octets(h_), h_.size());
  crypto_hash_sha256_update(&state, octets(data), data.size());
  crypto_hash_sha256_final(&state, octets(h_));
}

/// HKDF of section 4.3 with two outputs.
void Handshake::mix_key(Bytes input, Key& first, Key& second) noexcept {
  Key extracted;
  hmac(ck_, input, 0, extracted);
  hmac(extracted, {}, 1, first);
  hmac(extracted, first, 2, second);
  wipe(extracted);
}

bool Handshake::mix(const KeyPair& own, const Key& theirs) noexcept {
  Key secret;
  if (!shared_secret(own.secret, theirs, secret)) return false;
  Key next;
  mix_key(secret, next, k_);
  ck_ = next;
  wipe(secret);
  return true;
}

}  // namespace garrison::node
