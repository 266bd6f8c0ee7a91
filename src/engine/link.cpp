// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/link.hpp"

#include <algorithm>

namespace garrison {
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
    : seeded_(faults.drop, faults.delay, seed, trial),
      attacks_(std::move(attacks)),
      seed_(seed),
      trial_(trial) {
  if (faults.delay_rounds < 1) refuse("link.delay_rounds", std::to_string(faults.delay_rounds), "at least 1");
  if (!faults.cuts.empty()) channels_.push_back(scheduled_faults(network, std::move(faults.cuts)));
  if (!faults.lost.empty()) channels_.push_back(recorded_faults(network, std::move(faults.lost)));
  liar_.assign(static_cast<std::size_t>(network.agents()), 0);
  for (const auto& attack : attacks_) {
    attack->schedule().require_agents_below(network.agents());
    for (const int id : attack->schedule().everyone()) liar_[static_cast<std::size_t>(id)] = 1;
    memory_ = std::max(memory_, attack->age());
  }
}

void Link::require(const FieldList& message) const {
  for (const auto& attack : attacks_) attack->require(message, static_cast<int>(liar_.size()));
}

void Link::decide(std::int64_t sample, int round, const Links& links, std::span<Fate> fates) const {
  std::fill(fates.begin(), fates.end(), Fate::delivered);
  if (seeded_.any()) seeded_.decide(sample, round, links, fates);
  for (const auto& channel : channels_) channel->decide(sample, round, links, fates);
}

template <class Action>
bool Link::strike(const Hop& hop, const Action& action) const {
  const Random random(seed_, trial_, Purpose::attack);
  std::uint32_t salt = 0x40000000U;
  Hop told = hop;
  for (const auto& attack : attacks_) {
    told.salt = ++salt;
    const auto agents = attack->schedule().agents(hop.t);
    if (!std::binary_search(agents.begin(), agents.end(), hop.sender)) continue;
    if (!attack->schedule().strikes(random, hop.t, hop.sender, salt)) continue;
    if (!action(*attack, told, random)) return false;
  }
  return true;
}

int Link::age(const Hop& hop) const {
  int oldest = 0;
  strike(hop, [&](const MessageAttack& attack, const Hop&, const Random&) {
    oldest = std::max(oldest, attack.age());
    return true;
  });
  return oldest;
}

bool Link::rewrite(const Hop& hop, const FieldList& message, bool& changed) const {
  return strike(hop, [&](const MessageAttack& attack, const Hop& told, const Random& random) {
    changed = true;
    return attack.rewrite(told, random, message);
  });
}

}  // namespace garrison
