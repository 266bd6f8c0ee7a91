// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/certified_network.hpp"

#include "certificate/online/agent_certifier.hpp"
#include "garrison/wire/message.hpp"

namespace garrison {

using certificate::AgentCertifier;

struct CertifiedNetwork::Agents {
  std::vector<std::unique_ptr<AgentCertifier>> certifiers;
  std::vector<certificate::Evidence> said;  // of this round
};

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
}
CertifiedNetwork::~CertifiedNetwork() = default;

void CertifiedNetwork::reset(std::int64_t t) {
  for (const auto& one : all_->certifiers) one->reset(t);
  round_ = rounds_;
  bytes_ = samples_ = 0;
}

void CertifiedNetwork::begin(std::int64_t t, const double* y) {
  for (std::size_t i = 0; i < first_.size(); ++i) all_->certifiers[i]->begin(t, y + first_[i]);
  round_ = 0;
  ++samples_;
}

void CertifiedNetwork::say() {
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    all_->certifiers[i]->say(round_, all_->said[i]);
    bytes_ += static_cast<std::int64_t>(listeners_[i]) *
              static_cast<std::int64_t>(wire::size(all_->said[i], agents()));
  }
}

void CertifiedNetwork::hear(int agent, int sender) {
  all_->certifiers[static_cast<std::size_t>(agent)]->hear(round_, sender,
                                                          all_->said[static_cast<std::size_t>(sender)]);
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
  return all_->certifiers[static_cast<std::size_t>(agent)].get();
}

}  // namespace garrison
