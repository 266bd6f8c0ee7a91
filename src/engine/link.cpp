// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/link.hpp"

#include <algorithm>

namespace garrison {
namespace {
void require_probability(const char* which, double value) {
  if (!(value >= 0.0 && value <= 1.0)) refuse(which, text(value), "a probability in [0, 1]");
}
}  // namespace

LinkCounters& LinkCounters::operator+=(const LinkCounters& other) {
  sent += other.sent;
  lost += other.lost;
  late += other.late;
  forged += other.forged;
  refused += other.refused;
  return *this;
}

Link::Link(const Network& network, LinkFaults faults,
           std::vector<std::shared_ptr<const MessageAttack>> attacks, std::uint64_t seed, std::uint32_t trial)
    : faults_(faults), attacks_(std::move(attacks)), seed_(seed), trial_(trial) {
  require_probability("link.drop", faults_.drop);
  require_probability("link.delay", faults_.delay);
  if (faults_.delay_rounds < 1)
    refuse("link.delay_rounds", std::to_string(faults_.delay_rounds), "at least 1");
  liar_.assign(static_cast<std::size_t>(network.agents()), 0);
  for (const auto& attack : attacks_) {
    attack->schedule().require_agents_below(network.agents());
    for (const int id : attack->schedule().everyone()) liar_[static_cast<std::size_t>(id)] = 1;
  }
}

Link::Fate Link::fate(const Hop& hop) const {
  const Random random(seed_, trial_, Purpose::link);
  const auto address =
      static_cast<std::uint32_t>(hop.sender) * 65537U + static_cast<std::uint32_t>(hop.receiver);
  const auto index = 2U * static_cast<std::uint32_t>(hop.round);
  if (faults_.drop > 0.0 && random.uniform(hop.t, address, index) < faults_.drop) return Fate::lost;
  if (faults_.delay > 0.0 && random.uniform(hop.t, address, index + 1) < faults_.delay) return Fate::late;
  return Fate::delivered;
}

bool Link::rewrite(const Hop& hop, std::span<double> values, bool& changed) const {
  const Random random(seed_, trial_, Purpose::attack);
  std::uint32_t salt = 0x40000000U;
  Hop told = hop;
  for (const auto& attack : attacks_) {
    told.salt = ++salt;
    const auto agents = attack->schedule().agents(hop.t);
    if (!std::binary_search(agents.begin(), agents.end(), hop.sender)) continue;
    if (!attack->schedule().strikes(random, hop.t, hop.sender, salt)) continue;
    changed = true;
    if (!attack->rewrite(told, random, values)) return false;
  }
  return true;
}

}  // namespace garrison
