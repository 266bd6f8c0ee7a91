// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/certified_network.hpp"

#include "certificate/online/agent_certifier.hpp"
#include "flood.hpp"
#include "garrison/wire/message.hpp"

namespace garrison {

using certificate::AgentCertifier;

struct CertifiedNetwork::Agents {
  std::vector<std::unique_ptr<AgentCertifier>> certifiers;
  std::vector<certificate::Evidence> said;  // of this round
  // Samples without losses are done at once where everybody learns everything in one.
  detail::Flood flood;
  bool reaches_all = false;
  std::int64_t bare_bytes = 0;               // of such a sample, measurements and regions aside
  std::int64_t region_bytes = 0;             // of the regions
  std::int64_t bytes_of_region = 0;          // in one message
  std::vector<std::int64_t> measured_bytes;  // and of each measurement
  bool alike = false;  // all relay the same region, and where all is flooded also found the same

  void plan_at_once(const certificate::Plan& plan, const Network& network, int rounds,
                    const std::vector<int>& listeners);
  bool all_alike() const;
  /// Flooded, from one sample without losses on: one agent stands for all. Banks have a past of their own.
  bool one_for_all() const {
    return alike && certifiers.front()->flooded() && !certifiers.front()->has_bank();
  }
  std::int64_t bytes_of_first_regions(int rounds, const std::vector<int>& listeners) const;
};

/// Who hears what, and the bytes of it.
void CertifiedNetwork::Agents::plan_at_once(const certificate::Plan& plan, const Network& network, int rounds,
                                            const std::vector<int>& listeners) {
  const bool flooded = certifiers.front()->flooded();
  const bool direct = certifiers.front()->direct();
  if (!direct) flood = detail::Flood(network, flooded ? rounds : rounds - 1);
  reaches_all = rounds > 0 && (direct || flood.reaches_all());
  if (!reaches_all) return;
  for (int i = 0; i < network.agents(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::int64_t messages = static_cast<std::int64_t>(rounds) * listeners[at];
    bytes_of_region = static_cast<std::int64_t>(8 * said[at].ball.size());
    bare_bytes += messages * static_cast<std::int64_t>(wire::size(said[at], network.agents()));
    region_bytes += static_cast<std::int64_t>(flooded ? std::min(rounds, certificate::kRepeats) : rounds) *
                    listeners[at] * bytes_of_region;
    std::int64_t heard = listeners[at];  // how often this agent's measurement is
    if (flooded) {
      heard = 0;
      for (int j = 0; j < network.agents(); ++j)
        heard += static_cast<std::int64_t>(listeners[static_cast<std::size_t>(j)]) *
                 std::clamp(rounds - flood.hops(i, j), 0, certificate::kRepeats);
    }
    measured_bytes.insert(measured_bytes.end(), static_cast<std::size_t>(plan.outputs(i)), 8 * heard);
  }
}

bool CertifiedNetwork::Agents::all_alike() const {
  const AgentCertifier& first = *certifiers.front();
  if (first.direct()) return true;
  for (const auto& one : certifiers)
    if (!one->relays_the_same(first) || (first.flooded() && !one->found_the_same(first))) return false;
  return true;
}

/// Of a sample from which on regions are relayed, each agent's from the round after that of its coming.
std::int64_t CertifiedNetwork::Agents::bytes_of_first_regions(int rounds,
                                                              const std::vector<int>& listeners) const {
  std::int64_t bytes = 0;
  const int N = static_cast<int>(certifiers.size());
  for (int i = 0; i < N; ++i) {
    int earliest = rounds - 1;  // round in which it comes
    for (int j = 0; j < N; ++j)
      if (certifiers[static_cast<std::size_t>(j)]->memory().age >= 0)
        earliest = std::min(earliest, flood.hops(j, i));
    const auto at = static_cast<std::size_t>(i);
    bytes += static_cast<std::int64_t>(rounds - 1 - earliest) * listeners[at] * bytes_of_region;
  }
  return bytes;
}

CertifiedNetwork::CertifiedNetwork(std::shared_ptr<const certificate::Plan> plan, const Network& network,
                                   int rounds)
    : network_(network),
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
  all_->plan_at_once(*plan, network_, rounds_, listeners_);
}
CertifiedNetwork::~CertifiedNetwork() = default;

void CertifiedNetwork::reset(std::int64_t t) {
  for (const auto& one : all_->certifiers) one->reset(t);
  all_->alike = false;
  y_ = nullptr;
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
  y_ = y;
  round_ = 0;
  ++samples_;
}

/// Begins the sample, one agent at a time.
void CertifiedNetwork::start() {
  if (y_ == nullptr) return;
  auto& all = all_->certifiers;
  if (all_->one_for_all())
    for (std::size_t i = 1; i < all.size(); ++i) all[i]->copy(*all.front());
  all_->alike = false;
  for (std::size_t i = 0; i < first_.size(); ++i) all[i]->begin(t_, y_ + first_[i]);
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
    for (std::int64_t k = begin; k < end; ++k)
      heard(k, [&](int agent, int sender, const certificate::Evidence& said) {
        all_->certifiers[static_cast<std::size_t>(agent)]->hear(round_, sender, said);
      });
  });
  end_round(workers);
}

void CertifiedNetwork::hear(Workers& workers, const Routes& routes) {
  hear_all(workers, [&](std::int64_t k, const auto& hear) {
    const auto place = static_cast<std::size_t>(k);
    const Heard heard = routes.heard(place);
    for (std::size_t j = 0; j < heard.slots.size(); ++j) {
      const int sender = heard.senders[j];
      const std::size_t slot = heard.begin + heard.slots[j];
      const bool honest = slot < routes.first_lie();
      hear(routes.id(place), sender,
           honest ? all_->said[static_cast<std::size_t>(sender)] : lies_[slot - routes.first_lie()]);
    }
  });
}

void CertifiedNetwork::finish(Workers& workers) {
  if (y_ != nullptr && all_->alike) return at_once(workers);
  start();
  const bool lossless = round_ == 0;
  while (round_ < rounds_) {
    say();
    hear_all(workers, [&](std::int64_t i, const auto& hear) {
      for (const int j : network_.neighbours(static_cast<int>(i)))
        hear(static_cast<int>(i), j, all_->said[static_cast<std::size_t>(j)]);
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
  if (relaying && !first.direct())
    bytes_ += all_->region_bytes;
  else if (!first.flooded() && !first.direct())
    bytes_ += all_->bytes_of_first_regions(rounds_, listeners_);
  const std::int64_t sharing = first.direct() || first.flooded() ? 0 : others;
  for (std::size_t i = 1; i <= static_cast<std::size_t>(sharing); ++i) first.hear_relayed(*all[i]);
  for (std::size_t i = 1; i <= static_cast<std::size_t>(sharing); ++i) all[i]->copy_relayed(first);
  bytes_ += all_->bare_bytes;
  for (std::size_t k = 0; k < all_->measured_bytes.size(); ++k)
    bytes_ += std::abs(y_[k]) < kHuge ? all_->measured_bytes[k] : 0;
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
