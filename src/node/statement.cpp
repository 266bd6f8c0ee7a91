// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/statement.hpp"

namespace garrison::node {

namespace {
constexpr std::string_view kDomain = "garrison root 1";
constexpr std::string_view kProof = "GPROOF01";
constexpr std::size_t kDigestAt = 30;
using Message = std::array<std::byte, kDomain.size() + 32 + Statement::kSigned>;

Message message_of(const Statement& statement, const Key& run) noexcept {
  std::array<std::byte, Statement::kSize> bytes;
  statement.write(bytes.data());
  Message out;
  copy(text_bytes(kDomain), out.data());
  copy(run, out.data() + kDomain.size());
  copy(Bytes(bytes).first(Statement::kSigned), out.data() + kDomain.size() + run.size());
  return out;
}
}  // namespace

void Statement::write(std::byte* at) const noexcept {
  wire::store(at, sender);
  wire::store(at + 2, boot);
  wire::store(at + 10, static_cast<std::uint64_t>(first));
  wire::store(at + 18, static_cast<std::uint64_t>(last));
  wire::store(at + 26, count);
  copy(digest, at + kDigestAt);
  copy(signature, at + kSigned);
}

std::optional<Statement> Statement::read(Bytes bytes) noexcept {
  if (bytes.size() != kSize) return {};
  Statement s;
  const std::byte* at = bytes.data();
  s.sender = wire::load<std::uint16_t>(at);
  s.boot = wire::load<std::uint64_t>(at + 2);
  s.first = static_cast<std::int64_t>(wire::load<std::uint64_t>(at + 10));
  s.last = static_cast<std::int64_t>(wire::load<std::uint64_t>(at + 18));
  s.count = wire::load<std::uint32_t>(at + 26);
  copy(bytes.subspan(kDigestAt, s.digest.size()), s.digest.data());
  copy(bytes.subspan(kSigned), s.signature.data());
  const bool sane = s.first >= 0 && s.last >= s.first && s.last - s.first < kMostSamples;
  return sane ? std::optional(s) : std::nullopt;
}

void sign(Statement& statement, const Key& run, const SigningKey& key) noexcept {
  statement.signature = signature_of(message_of(statement, run), key);
}
bool genuine(const Statement& statement, const Key& run, const Key& open) noexcept {
  return signed_by(message_of(statement, run), statement.signature, open);
}

bool contradict(const Statement& a, const Statement& b) noexcept {
  const bool overlap = a.first <= b.last && b.first <= a.last;
  const bool equal = a.first == b.first && a.last == b.last && a.count == b.count && a.digest == b.digest;
  return a.sender == b.sender && a.boot == b.boot && overlap && !equal;
}

Key leaf_of(std::int64_t sample, int round, Bytes body) noexcept {
  std::array<std::byte, 12> place;
  wire::store(place.data(), static_cast<std::uint64_t>(sample));
  wire::store(place.data() + 8, static_cast<std::uint32_t>(round));
  Key out;
  hash({}, {text_bytes("garrison leaf 1"), place, body}, out);
  return out;
}
Key chained(const Key& before, const Key& leaf) noexcept {
  Key out;
  hash({}, {text_bytes("garrison node 1"), before, leaf}, out);
  return out;
}

void Proof::write(std::byte* at) const noexcept {
  copy(text_bytes(kProof), at);
  copy(run, at + 8);
  a.write(at + 40);
  b.write(at + 40 + Statement::kSize);
}
std::optional<Proof> Proof::read(Bytes bytes) noexcept {
  if (bytes.size() != kSize || !same(bytes.first(8), text_bytes(kProof))) return {};
  const auto a = Statement::read(bytes.subspan(40, Statement::kSize));
  const auto b = Statement::read(bytes.subspan(40 + Statement::kSize));
  if (!a || !b) return {};
  Proof out{{}, *a, *b};
  copy(bytes.subspan(8, 32), out.run.data());
  return out;
}

}  // namespace garrison::node
