// SPDX-License-Identifier: Apache-2.0
#include "evidence_bytes.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/wire/message.hpp"

namespace garrison::detail {

using certificate::kRepeats;

namespace {

bool usable(double y) { return std::abs(y) < kHuge; }

}  // namespace

EvidenceBytes::EvidenceBytes(const certificate::Plan& plan, const Network& network, int rounds,
                             const Flood& flood, std::span<const certificate::Evidence> said)
    : plan_(&plan),
      flood_(&flood),
      rounds_(rounds),
      listeners_(said.size()),
      region_(static_cast<std::int64_t>(8 * said.front().ball.size())),
      present_(static_cast<std::size_t>(plan.first.back())),
      has_(said.size()),
      spoken_(static_cast<std::size_t>(rounds)) {
  for (int i = 0; i < network.agents(); ++i) {
    for (const int j : network.neighbours(i)) ++listeners_[static_cast<std::size_t>(j)];
    bare_.push_back(
        static_cast<std::int64_t>(wire::size(said[static_cast<std::size_t>(i)], network.agents())));
  }
  if (plan.wanted.spread != certificate::Spread::flooded) return;
  for (int i = 0; i < network.agents(); ++i) {
    std::int64_t heard = 0;  // how often this agent's measurement is
    for (int j = 0; j < network.agents(); ++j)
      heard += static_cast<std::int64_t>(listeners_[static_cast<std::size_t>(j)]) *
               std::clamp(rounds - flood.hops(i, j), 0, kRepeats);
    travelled_.insert(travelled_.end(), static_cast<std::size_t>(plan.outputs(i)), 8 * heard);
  }
}

bool EvidenceBytes::same_pattern(const double* y, bool relaying) {
  bool same = bare_all_ >= 0 && relaying == relaying_;
  relaying_ = relaying;
  for (std::size_t k = 0; k < present_.size(); ++k) {
    const char present = usable(y[k]) ? 1 : 0;
    same = same && present == present_[k];
    present_[k] = present;
  }
  return same;
}

/// Flooded: rounds in which an agent has something to say, of the measurements that are there.
int EvidenceBytes::spoken_rounds(int agent) {
  const auto say = [&](int from) {
    for (int round = from; round < std::min(from + kRepeats, rounds_); ++round)
      spoken_[static_cast<std::size_t>(round)] = 1;
  };
  std::fill(spoken_.begin(), spoken_.end(), 0);
  if (relaying_) say(0);
  for (std::size_t j = 0; j < has_.size(); ++j)
    if (has_[j] != 0) say(flood_->hops(static_cast<int>(j), agent));
  return static_cast<int>(std::count(spoken_.begin(), spoken_.end(), 1));
}

std::int64_t EvidenceBytes::flooded(const double* y, bool relaying) {
  if (!same_pattern(y, relaying)) {
    for (std::size_t i = 0; i < has_.size(); ++i) {
      const auto begin = present_.begin() + plan_->first[i];
      const auto end = present_.begin() + plan_->first[i + 1];
      has_[i] = std::find(begin, end, 1) != end ? 1 : 0;
    }
    bare_all_ = 0;
    for (std::size_t i = 0; i < has_.size(); ++i)
      bare_all_ += bare_[i] * listeners_[i] * spoken_rounds(static_cast<int>(i));
    if (relaying)
      for (const int listeners : listeners_) bare_all_ += std::min(rounds_, kRepeats) * listeners * region_;
  }
  std::int64_t bytes = bare_all_;
  for (std::size_t k = 0; k < travelled_.size(); ++k) bytes += present_[k] != 0 ? travelled_[k] : 0;
  return bytes;
}

std::int64_t EvidenceBytes::local(const double* y, std::span<const int> since) const {
  std::int64_t bytes = 0;
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    std::int64_t own = 0;
    for (int k = plan_->first[i]; k < plan_->first[i + 1]; ++k) own += usable(y[k]) ? 8 : 0;
    std::int64_t of_each = 0;
    for (int round = 0; round < rounds_; ++round) {
      const std::int64_t measured = round == 0 ? own : 0;
      const std::int64_t region = round >= since[i] && plan_->relays_in(round, rounds_) ? region_ : 0;
      if (measured + region > 0) of_each += bare_[i] + measured + region;
    }
    bytes += listeners_[i] * of_each;
  }
  return bytes;
}

}  // namespace garrison::detail
