// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/routes.hpp"

#include <algorithm>

namespace garrison {

Routes::Routes(const Network& network, std::span<const int> order, int states, int rounds)
    : order_(order.begin(), order.end()), states_(states), rounds_(rounds) {
  std::vector<std::uint32_t> position(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k)
    position[static_cast<std::size_t>(order_[k])] = static_cast<std::uint32_t>(k);
  for (const int i : order_) {
    first_.push_back(slots_.size());
    for (const int j : network.neighbours(i)) {
      slots_.push_back(position[static_cast<std::size_t>(j)]);
      senders_.push_back(j);
      receivers_.push_back(i);
    }
  }
  first_.push_back(slots_.size());
  listeners_.resize(order_.size());
  for (const std::uint32_t sender : slots_) ++listeners_[sender];
  delivered_.resize(slots_.size());
  delivered_from_.resize(slots_.size());
  received_.resize(order_.size());
  deliverable_.resize(order_.size());
  connect(nullptr);
}

std::size_t Routes::connect(Link* link) {
  link_ = link;
  depth_ = 2 + (link == nullptr ? 0 : posts_in(link->memory()));
  std::size_t lies = 0;
  if (link != nullptr)
    for (const int sender : senders_) lies += link->lies(sender) ? 1 : 0;
  lies_ = lies > 0;
  fates_.assign(senders_.size(), Fate::delivered);
  posted_ = 0;
  current_ = outgoing_ = 0;
  return first_lie() + lies;
}

void Routes::deliver(std::int64_t t, int round, const Letters& letters) {
  LinkCounters counters;
  if (link_ != nullptr) link_->decide(t, round, {senders_, receivers_}, fates_);
  counters.lost = std::count(fates_.begin(), fates_.end(), Fate::lost);
  counters.late = std::count(fates_.begin(), fates_.end(), Fate::late);
  const std::size_t first_slot = current();
  std::size_t forged = first_lie();
  for (std::size_t k = 0; k < order_.size(); ++k) {
    std::size_t place = first_[k];
    for (std::size_t e = first_[k]; e < first_[k + 1]; ++e) {
      if (lies_ && link_->lies(senders_[e])) {
        if (fates_[e] != Fate::delivered) continue;
        const Hop hop{t, round, senders_[e], order_[k], states_};
        if (!forge(hop, e, forged, k, letters, counters)) continue;
        delivered_[place] = static_cast<std::uint32_t>(forged++);
        delivered_from_[place++] = senders_[e];
        continue;
      }
      // Without branches: chance decides, which no processor can foresee.
      const bool here = fates_[e] == Fate::delivered;
      const bool taken = here & (deliverable_[slots_[e]] != 0);
      delivered_[place] = static_cast<std::uint32_t>(first_slot) + slots_[e];
      delivered_from_[place] = senders_[e];
      place += taken ? 1U : 0U;
      counters.sent += taken ? 1 : 0;
      counters.refused += here != taken ? 1 : 0;
    }
    received_[k] = place - first_[k];
  }
  if (link_ != nullptr) link_->counters += counters;
}

bool Routes::forge(const Hop& hop, std::size_t e, std::size_t to, std::size_t k, const Letters& letters,
                   LinkCounters& counters) {
  const std::size_t age = posts_in(link_->age(hop));
  if (age >= posted_) return ++counters.lost, false;  // nothing that old
  const Letter letter = letters.copy(base(posted_ - 1 - age) + slots_[e], to, k, hop.sender);
  Hop told = hop;
  told.entries = letter.entries;
  bool changed = false;
  if (!link_->rewrite(told, letter.fields, changed)) return ++counters.lost, false;
  if (!letters.deliverable(to)) return ++counters.refused, false;
  return ++(changed ? counters.forged : counters.sent), true;
}

}  // namespace garrison
