// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/crypto.hpp"

#include <sodium.h>

#include "node/octets.hpp"

namespace garrison::node {

namespace {
using Nonce = std::array<std::byte, crypto_aead_chacha20poly1305_ietf_NPUBBYTES>;

Nonce nonce_of(std::uint64_t counter) noexcept {
  Nonce nonce{};
  wire::store(nonce.data() + 4, counter);
  return nonce;
}
}  // namespace

bool start_crypto() noexcept { return sodium_init() >= 0; }

KeyPair key_pair(const Key& secret) noexcept {
  KeyPair pair{secret, {}};
  crypto_scalarmult_base(octets(pair.open), octets(secret));
  return pair;
}
bool shared_secret(const Key& secret, const Key& theirs, Key& out) noexcept {
  return crypto_scalarmult(octets(out), octets(secret), octets(theirs)) == 0;
}

SigningKey signing_key(const Key& seed, Key& open) noexcept {
  SigningKey out;
  crypto_sign_seed_keypair(octets(open), octets(out), octets(seed));
  return out;
}
Signature signature_of(Bytes message, const SigningKey& key) noexcept {
  Signature out;
  crypto_sign_detached(octets(out), nullptr, octets(message), message.size(), octets(key));
  return out;
}
bool signed_by(Bytes message, const Signature& signature, const Key& open) noexcept {
  return crypto_sign_verify_detached(octets(signature), octets(message), message.size(), octets(open)) == 0;
}

std::size_t seal(const Key& key, std::uint64_t counter, Bytes authenticated, Bytes plain,
                 std::byte* out) noexcept {
  const Nonce nonce = nonce_of(counter);
  unsigned long long size = 0;
  crypto_aead_chacha20poly1305_ietf_encrypt(octets(out), &size, octets(plain), plain.size(),
                                            octets(authenticated), authenticated.size(), nullptr,
                                            octets(nonce), octets(key));
  return static_cast<std::size_t>(size);
}
bool open(const Key& key, std::uint64_t counter, Bytes authenticated, Bytes sealed, std::byte* out) noexcept {
  const Nonce nonce = nonce_of(counter);
  unsigned long long size = 0;
  return crypto_aead_chacha20poly1305_ietf_decrypt(octets(out), &size, nullptr, octets(sealed), sealed.size(),
                                                   octets(authenticated), authenticated.size(), octets(nonce),
                                                   octets(key)) == 0;
}

void hash(Bytes key, std::initializer_list<Bytes> pieces, Room out) noexcept {
  crypto_generichash_state state;
  crypto_generichash_init(&state, key.empty() ? nullptr : octets(key), key.size(), out.size());
  for (const Bytes piece : pieces) crypto_generichash_update(&state, octets(piece), piece.size());
  crypto_generichash_final(&state, octets(out), out.size());
}
bool same(Bytes a, Bytes b) noexcept {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}
void wipe(Room secret) noexcept { sodium_memzero(secret.data(), secret.size()); }

}  // namespace garrison::node
