// SPDX-License-Identifier: Apache-2.0
// What a node signs of its messages: once a batch, so that who tells different neighbours different things
// can be convicted by two of its own statements, offline, with its public key alone.
#pragma once

#include <optional>

#include "garrison/node/crypto.hpp"

namespace garrison::node {

/// "From sample `first` to `last` I have sent `count` bodies, whose digest is this": docs/node.md has the
/// layout.
struct Statement {
  static constexpr std::size_t kSigned = 62;  ///< bytes before the signature
  static constexpr std::size_t kSize = kSigned + std::tuple_size_v<Signature>;
  static constexpr std::int64_t kMostSamples = 1 << 16;

  std::uint16_t sender = 0;
  std::uint64_t boot = 0;
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::uint32_t count = 0;
  Key digest{};
  Signature signature{};

  bool operator==(const Statement&) const = default;
  /// `at` has room for kSize.
  void write(std::byte* at) const noexcept;
  /// Nothing unless it is kSize bytes about 1 to kMostSamples samples.
  static std::optional<Statement> read(Bytes bytes) noexcept;
};

/// `run`: what both ends of every link have agreed on; a statement is about one run only.
void sign(Statement& statement, const Key& run, const SigningKey& key) noexcept;
bool genuine(const Statement& statement, const Key& run, const Key& open) noexcept;
/// Of one sender and one of its starts, about a common sample, and not the same: no honest node signs both.
bool contradict(const Statement& a, const Statement& b) noexcept;

/// A body as it goes into a digest, and a digest of bodies with one more.
Key leaf_of(std::int64_t sample, int round, Bytes body) noexcept;
Key chained(const Key& before, const Key& leaf) noexcept;

/// Two statements that contradict each other, with the run they are of: "GPROOF01", run, statement,
/// statement.
struct Proof {
  static constexpr std::size_t kSize = 8 + 32 + 2 * Statement::kSize;
  Key run{};
  Statement a;
  Statement b;

  void write(std::byte* at) const noexcept;
  static std::optional<Proof> read(Bytes bytes) noexcept;
  /// Whether it convicts who has this public key.
  bool convicts(const Key& open) const noexcept {
    return contradict(a, b) && genuine(a, run, open) && genuine(b, run, open);
  }
};

}  // namespace garrison::node
