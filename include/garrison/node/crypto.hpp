// SPDX-License-Identifier: Apache-2.0
// The primitives that a node takes from libsodium, by the names that its protocol has for them.
// `start_crypto` once before all others.
#pragma once

#include <initializer_list>
#include <string_view>

#include "garrison/node/bytes.hpp"

namespace garrison::node {

struct KeyPair {
  Key secret{};
  Key open{};
};
/// Ed25519 (RFC 8032): seed and public key.
using SigningKey = std::array<std::byte, 64>;
using Signature = std::array<std::byte, 64>;
/// False when the system has no random numbers to give.
bool start_crypto() noexcept;

KeyPair key_pair(const Key& secret) noexcept;
/// X25519; false when the result is zero (a key of small order).
bool shared_secret(const Key& secret, const Key& theirs, Key& out) noexcept;

/// The key that a seed gives, and its public half.
SigningKey signing_key(const Key& seed, Key& open) noexcept;
Signature signature_of(Bytes message, const SigningKey& key) noexcept;
bool signed_by(Bytes message, const Signature& signature, const Key& open) noexcept;

/// ChaCha20-Poly1305 (RFC 8439) with the nonce 0000 | counter. `out` has room for plain + kTag; returns its
/// size.
std::size_t seal(const Key& key, std::uint64_t counter, Bytes authenticated, Bytes plain,
                 std::byte* out) noexcept;
/// `out` has room for sealed - kTag. False when the tag does not fit; `out` is then not to be used.
bool open(const Key& key, std::uint64_t counter, Bytes authenticated, Bytes sealed, std::byte* out) noexcept;

/// BLAKE2b of up to three pieces, keyed unless the key is empty; `out` has 16 to 64 bytes.
void hash(Bytes key, std::initializer_list<Bytes> pieces, Room out) noexcept;
bool same(Bytes a, Bytes b) noexcept;  ///< in constant time
void wipe(Room secret) noexcept;

inline Bytes text_bytes(std::string_view text) noexcept {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

}  // namespace garrison::node
