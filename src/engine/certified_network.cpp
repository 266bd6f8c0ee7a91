// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/certified_network.hpp"

#include "certificate/online/agent_certifier.hpp"
#include "evidence_bytes.hpp"
#include "flood.hpp"
#include "garrison/wire/message.hpp"

namespace garrison {

using certificate::AgentCertifier;
using certificate::Told;

struct CertifiedNetwork::Agents {
  std::vector<std::unique_ptr<AgentCertifier>> certifiers;
  std::vector<certificate::Evidence> said;  // of this round
  std::vector<char> silent;                 // of this round: who says nothing
  // Samples without losses are done at once where everybody learns everything in one.
  detail::Flood flood;
  bool reaches_all = false;
  detail::EvidenceBytes bytes;
  std::vector<int> since;  // round from which on each agent has a region to relay; rounds = never
  bool alike = false;      // all relay the same region, and where all is flooded also found the same

  /// Flooded, from one sample without losses on: one agent stands for all. Banks have a past of their own.
  bool one_for_all() const {
    return alike && certifiers.front()->flooded() && !certifiers.front()->has_bank();
  }
  bool all_alike() const;
  /// In evidence that holds nothing, which is said by bytes all the same.
  bool says_missing(int sender) const {
    const auto j = static_cast<std::size_t>(sender);
    return silent[j] == 0 && said[j].silent();
  }
  void plan_at_once(const certificate::Plan& plan, const Network& network, int rounds,
                    const std::vector<int>& listeners);
  /// Fills `since`: a region comes from the nearest agent that found one after the first round.
  void find_first_regions(int rounds);
};

void CertifiedNetwork::Agents::plan_at_once(const certificate::Plan& plan, const Network& network, int rounds,
                                            const std::vector<int>& listeners) {
  const AgentCertifier& first = *certifiers.front();
  reaches_all = rounds > 0 && (first.direct() || plan.reach <= (first.flooded() ? rounds : rounds - 1));
  if (!reaches_all) return;
  if (!first.direct()) flood = detail::Flood(network);
  bytes = detail::EvidenceBytes(plan, listeners, rounds, flood, said);
  since.assign(certifiers.size(), rounds);
}

void CertifiedNetwork::Agents::find_first_regions(int rounds) {
  for (std::size_t i = 0; i < since.size(); ++i) {
    since[i] = rounds;
    for (std::size_t j = 0; j < since.size(); ++j)
      if (certifiers[j]->memory().age >= 0)
        since[i] = std::min(since[i], flood.hops(static_cast<int>(j), static_cast<int>(i)) + 1);
  }
}

bool CertifiedNetwork::Agents::all_alike() const {
  const AgentCertifier& first = *certifiers.front();
  if (first.direct()) return true;
  for (const auto& one : certifiers)
    if (!one->relays_the_same(first) || (first.flooded() && !one->found_the_same(first))) return false;
  return true;
}

CertifiedNetwork::CertifiedNetwork(std::shared_ptr<const certificate::Plan> plan, const Network& network,
                                   int rounds)
    : plan_(plan),
      network_(network),
      rounds_(rounds),
      listeners_(static_cast<std::size_t>(network.agents())),
      all_(std::make_unique<Agents>()) {
  for (int i = 0; i < network.agents(); ++i) {
    first_.push_back(plan->first[static_cast<std::size_t>(i)]);
    for (const int j : network.neighbours(i)) ++listeners_[static_cast<std::size_t>(j)];
    all_->certifiers.push_back(std::make_unique<AgentCertifier>(plan, i, network.neighbours(i), rounds));
    certificate::Evidence empty;
    all_->certifiers.back()->shape_evidence(i, empty);
    all_->said.push_back(std::move(empty));
  }
  all_->silent.resize(all_->said.size());
  told_.resize(all_->said.size());
  if (plan_->derives()) derived_.resize(static_cast<std::size_t>(plan_->first.back()));
  all_->plan_at_once(*plan, network_, rounds_, listeners_);
}
CertifiedNetwork::~CertifiedNetwork() = default;

void CertifiedNetwork::reset(std::int64_t t) {
  for (const auto& one : all_->certifiers) one->reset(t);
  all_->alike = false;
  y_ = nullptr;
  std::fill(told_.begin(), told_.end(), Told::never_derived);
  round_ = rounds_;
  bytes_ = samples_ = 0;
}

void CertifiedNetwork::begin(std::int64_t t, const double* y, const Change& change) {
  const bool other =
      change.rows != nullptr || change.variance != nullptr || change.A != nullptr || change.Q != nullptr;
  if (other || varied_) {
    Change here = change;
    if (change.rows != nullptr) {
      rows_ = change.rows->transpose();
      here.rows = &rows_;
    }
    for (const auto& one : all_->certifiers) one->vary(here);
  }
  varied_ = other;
  t_ = t;
  y_ = measured_ = y;
  round_ = 0;
  ++samples_;
}

void CertifiedNetwork::derive(int agent, const double* x) {
  const auto i = static_cast<std::size_t>(agent);
  const double* const y = measured_ + first_[i];
  told_[i] = plan_->tell(agent, y, varied_ ? nullptr : x, derived_.data() + first_[i]);
  y_ = derived_.data();
}

/// Begins the sample, one agent at a time.
void CertifiedNetwork::start() {
  if (y_ == nullptr) return;
  auto& all = all_->certifiers;
  if (all_->one_for_all())
    for (std::size_t i = 1; i < all.size(); ++i) all[i]->copy(*all.front());
  all_->alike = false;
  for (std::size_t i = 0; i < first_.size(); ++i) all[i]->begin(t_, y_ + first_[i], told_[i]);
  y_ = nullptr;
}

void CertifiedNetwork::keep_lies(std::size_t places) {
  lies_.resize(std::max<std::size_t>(places, 1));
  std::size_t most = 0;
  for (const certificate::Evidence& one : all_->said) most = std::max(most, one.measurements.size());
  for (certificate::Evidence& lie : lies_) {
    lie = all_->said.front();
    lie.measurements.reserve(most);
  }
}

void CertifiedNetwork::say() {
  start();
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    all_->certifiers[i]->say(round_, all_->said[i]);
    all_->silent[i] = all_->certifiers[i]->spares(round_, all_->said[i]) ? 1 : 0;
    if (all_->silent[i] != 0) continue;
    bytes_ += static_cast<std::int64_t>(listeners_[i]) *
              static_cast<std::int64_t>(wire::size(all_->said[i], agents()));
  }
}

certificate::Evidence& CertifiedNetwork::copy(std::size_t place, int sender) {
  return lies_[place] = all_->said[static_cast<std::size_t>(sender)];
}

template <class Heard>
void CertifiedNetwork::hear_all(Workers& workers, const Heard& heard) {
  workers.split(agents(), [&](std::int64_t begin, std::int64_t end, int) {
    for (std::int64_t k = begin; k < end; ++k) heard(k);
  });
  end_round(workers);
}

/// Whether the measurements of this agent follow from its message of this round where no bytes say more.
bool CertifiedNetwork::derives_now(int sender) const {
  return round_ == 0 && !varied_ && told_[static_cast<std::size_t>(sender)] != Told::never_derived;
}

void CertifiedNetwork::hear_honest(AgentCertifier& listener, int sender) const {
  const auto j = static_cast<std::size_t>(sender);
  if (all_->silent[j] == 0)
    listener.hear(round_, sender, all_->said[j]);
  else if (derives_now(sender))
    listener.hear_numbers(sender, derived_.data() + first_[j]);
}

void CertifiedNetwork::hear(Workers& workers, const Routes& routes, const Sensed& sensed) {
  hear_all(workers, [&](std::int64_t k) {
    const auto place = static_cast<std::size_t>(k);
    const Heard heard = routes.heard(place);
    for (std::size_t j = 0; j < heard.slots.size(); ++j) {
      const int sender = heard.senders[j];
      const std::size_t slot = heard.begin + heard.slots[j];
      const certificate::Evidence* const lie =
          slot < routes.first_lie() ? nullptr : &lies_[slot - routes.first_lie()];
      AgentCertifier& listener = *all_->certifiers[static_cast<std::size_t>(routes.id(place))];
      if (lie == nullptr)
        hear_honest(listener, sender);
      else if (!lie->silent())
        listener.hear(round_, sender, *lie);
      else if (derives_now(sender) && !all_->says_missing(sender))
        listener.hear_estimate(sender, sensed(slot));  // who takes all of it away leaves no bytes
    }
  });
}

void CertifiedNetwork::finish(Workers& workers) {
  if (y_ != nullptr && all_->alike) return at_once(workers);
  start();
  const bool lossless = round_ == 0;
  while (round_ < rounds_) {
    say();
    hear_all(workers, [&](std::int64_t i) {
      for (const int j : network_.neighbours(static_cast<int>(i)))
        hear_honest(*all_->certifiers[static_cast<std::size_t>(i)], j);
    });
  }
  all_->alike = lossless && all_->reaches_all && all_->all_alike();
}

/// A sample in which everybody learns everything, from a region that all share. Flooded, the witness of one
/// agent is that of all; direct, nothing is shared.
void CertifiedNetwork::at_once(Workers& workers) {
  auto& all = all_->certifiers;
  AgentCertifier& first = *all.front();
  const std::int64_t others = all_->one_for_all() ? 0 : agents() - 1;
  first.begin_knowing(t_, y_, nullptr);
  const bool relaying = first.memory().age >= 0;
  workers.split(others, [&](std::int64_t begin, std::int64_t end, int) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      all[i + 1]->begin_knowing(t_, y_, first.direct() ? nullptr : &first);
      if (!first.flooded()) all[i + 1]->witness();
    }
  });
  first.witness();
  if (first.flooded())
    workers.split(others, [&](std::int64_t begin, std::int64_t end, int) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
        all[i + 1]->adopt(first);
    });
  if (first.flooded()) {
    bytes_ += all_->bytes.flooded(y_, relaying);
  } else {
    if (relaying)
      std::fill(all_->since.begin(), all_->since.end(), 0);
    else if (!first.direct())
      all_->find_first_regions(rounds_);
    bytes_ += all_->bytes.local(y_, told_, all_->since);
  }
  const std::int64_t sharing = first.direct() || first.flooded() ? 0 : others;
  for (std::size_t i = 1; i <= static_cast<std::size_t>(sharing); ++i) first.hear_relayed(*all[i]);
  for (std::size_t i = 1; i <= static_cast<std::size_t>(sharing); ++i) all[i]->copy_relayed(first);
  round_ = rounds_;
  y_ = nullptr;
}

void CertifiedNetwork::end_round(Workers& workers) {
  auto& all = all_->certifiers;
  if (all.front()->judges_in(round_)) {
    // Agents that know the same share one calculation: the one of those that know most is shared.
    std::size_t most = 0;
    for (std::size_t i = 1; i < all.size(); ++i)
      if (all[i]->known_rows() > all[most]->known_rows()) most = i;
    all[most]->witness();
    workers.split(agents(), [&](std::int64_t begin, std::int64_t end, int) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        if (i == most) continue;
        if (all[i]->knows_the_same(*all[most]))
          all[i]->adopt(*all[most]);
        else
          all[i]->witness();
      }
    });
  }
  ++round_;
}

const certificate::Certifier* CertifiedNetwork::of(int agent) const {
  const auto& all = all_->certifiers;
  return all[all_->one_for_all() ? 0 : static_cast<std::size_t>(agent)].get();
}

}  // namespace garrison
