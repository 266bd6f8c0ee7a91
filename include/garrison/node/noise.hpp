// SPDX-License-Identifier: Apache-2.0
// Noise_KK_25519_ChaChaPoly_SHA256 (The Noise Protocol Framework, revision 34): both static keys are known
// beforehand, so that a neighbour is who the roster says, and nobody else is.
#pragma once

#include "garrison/node/crypto.hpp"

namespace garrison::node {

/// Threads: one at a time.
class Handshake {
 public:
  enum class Role : std::uint8_t { initiator, responder };

  Handshake() = default;
  Handshake(Role role, Bytes prologue, const KeyPair& own, const Key& theirs) noexcept;

  /// Our message: e, es, ss of the initiator, or e, ee, se of the responder. `out` has room for
  /// 32 + payload + 16. False when the other's key is of small order.
  bool write(Bytes payload, const Key& ephemeral, std::byte* out) noexcept;
  /// Theirs; `payload` has room for message - 48. False when it is not theirs for this prologue.
  bool read(Bytes message, std::byte* payload) noexcept;
  /// After both messages.
  void split(Key& sending, Key& receiving) noexcept;
  const Key& transcript() const noexcept { return h_; }

 private:
  void mix_hash(Bytes data) noexcept;
  void mix_key(Bytes input, Key& first, Key& second) noexcept;
  bool mix(const KeyPair& own, const Key& theirs) noexcept;

  Role role_ = Role::initiator;
  KeyPair s_;
  KeyPair e_;
  Key rs_{};
  Key re_{};
  Key h_{};
  Key ck_{};
  Key k_{};
};

}  // namespace garrison::node
