// SPDX-License-Identifier: Apache-2.0
// Who a node is: an Ed25519 key, of which the links' X25519 keys are made.
#pragma once

#include <string>

#include "garrison/node/crypto.hpp"

namespace garrison::node {

struct Identity {
  Key seed{};
  Key open{};        ///< Ed25519, what a roster has
  KeyPair exchange;  ///< X25519
};

Identity identity_of(const Key& seed);
Key random_seed();
/// False for bytes that are no key.
bool exchange_key(const Key& open, Key& out) noexcept;

std::string base64(Bytes bytes);
/// @throws InvalidInput unless it is 32 bytes in base64 (and, for `open_key`, a key)
Key key_from(const std::string& which, const std::string& base64);
Key open_key_from(const std::string& which, const std::string& base64);

/// "garrison-key-1 " and the seed in base64, for its owner's eyes alone. Refuses to replace a file.
void write_key(const std::string& path, const Identity& identity);
/// @throws InvalidInput when others than the owner may read it, or it is no key
Identity read_key(const std::string& path);

}  // namespace garrison::node
