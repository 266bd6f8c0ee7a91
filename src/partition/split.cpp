// SPDX-License-Identifier: Apache-2.0
#include "partition/split.hpp"

#include <algorithm>

#include "garrison/wire/archive.hpp"
#include "garrison/wire/blake2b.hpp"

namespace garrison::partition {
namespace {

constexpr std::uint32_t kMagic = 0x31545047;  // "GPT1"

/// What a cache holds.
struct Cached {
  std::uint32_t magic = kMagic;
  int ranks = 0;
  std::string description;
  std::vector<std::int32_t> owner;

  template <class V>
  void visit(V& v) {
    v("magic", magic);
    v("ranks", ranks);
    v("description", description);
    v("owner", owner);
  }
};

/// On one rank of a balanced partition.
std::int64_t most_agents(std::size_t agents, int ranks) {
  return static_cast<std::int64_t>(kMostImbalance * static_cast<double>(agents) / ranks + 1.0);
}

}  // namespace

std::string unbalanced(std::span<const std::int32_t> owner, int ranks) {
  std::vector<std::int64_t> size(static_cast<std::size_t>(ranks), 0);
  for (const std::int32_t rank : owner) {
    if (rank < 0 || rank >= ranks) return "an agent on rank " + std::to_string(rank);
    ++size[static_cast<std::size_t>(rank)];
  }
  const auto [least, most] = std::minmax_element(size.begin(), size.end());
  if (*least == 0) return "no agent on rank " + std::to_string(least - size.begin());
  if (*most > most_agents(owner.size(), ranks))
    return amount(*most, "agent") + " on rank " + std::to_string(most - size.begin()) + " of " +
           std::to_string(ranks);
  return "";
}

void require_balanced(const std::string& source, std::span<const std::int32_t> owner, int ranks) {
  const std::string why = unbalanced(owner, ranks);
  if (!why.empty())
    refuse("partition (" + source + ")", why,
           "1 to " + amount(most_agents(owner.size(), ranks), "agent") + " on every rank",
           "use fewer ranks, or [partition].method = \"blocks\"");
}

std::vector<std::byte> partition_bytes(std::span<const std::int32_t> owner, int ranks,
                                       const std::string& description) {
  auto bytes = wire::to_bytes(Cached{kMagic, ranks, description, {owner.begin(), owner.end()}});
  const std::uint64_t sum = wire::checksum(bytes);
  bytes.resize(bytes.size() + 8);
  wire::store(bytes.data() + bytes.size() - 8, sum);
  return bytes;
}

std::vector<std::int32_t> partition_of(std::span<const std::byte> bytes, int agents, int ranks,
                                       const std::string& description) {
  if (bytes.size() < 8) return {};
  const auto content = bytes.first(bytes.size() - 8);
  if (wire::load<std::uint64_t>(bytes.data() + content.size()) != wire::checksum(content)) return {};
  Cached cached;
  if (wire::from_bytes(content, agents, cached) != Refusal::none) return {};
  const bool fits = cached.magic == kMagic && cached.ranks == ranks && cached.description == description &&
                    cached.owner.size() == static_cast<std::size_t>(agents);
  return fits ? cached.owner : std::vector<std::int32_t>{};
}

std::vector<int> agents_of(std::span<const std::int32_t> owner, int rank) {
  std::vector<int> ids;
  for (std::size_t i = 0; i < owner.size(); ++i)
    if (owner[i] == rank) ids.push_back(static_cast<int>(i));
  return ids;
}

}  // namespace garrison::partition
