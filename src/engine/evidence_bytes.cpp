// SPDX-License-Identifier: Apache-2.0
#include "evidence_bytes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "garrison/wire/message.hpp"

namespace garrison::detail {

using certificate::kRepeats;
using certificate::Told;

namespace {

bool usable(double y) { return std::abs(y) < kHuge; }

}  // namespace

EvidenceBytes::EvidenceBytes(const certificate::Plan& plan, std::vector<int> listeners, int rounds,
                             const Flood& flood, std::span<const certificate::Evidence> said)
    : plan_(&plan),
      flood_(&flood),
      rounds_(rounds),
      listeners_(std::move(listeners)),
      region_(static_cast<std::int64_t>(8 * said.front().ball.size())),
      present_(static_cast<std::size_t>(plan.first.back())),
      has_(said.size()),
      spoken_(static_cast<std::size_t>(rounds)) {
  const auto agents = static_cast<int>(said.size());
  for (const certificate::Evidence& one : said)
    bare_.push_back(static_cast<std::int64_t>(wire::size(one, agents)));
  if (plan.wanted.spread != certificate::Spread::flooded) return;
  for (int i = 0; i < agents; ++i) {
    std::int64_t heard = 0;  // how often this agent's measurement is
    for (int j = 0; j < agents; ++j)
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

std::int64_t EvidenceBytes::local(const double* y, std::span<const Told> told,
                                  std::span<const int> since) const {
  const int first = plan_->first_relay(rounds_);
  const int end = region_ > 0 ? plan_->relay_end(rounds_) : 0;
  std::int64_t bytes = 0;
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    std::int64_t own = 0;
    for (int k = plan_->first[i]; k < plan_->first[i + 1]; ++k) own += usable(y[k]) ? 8 : 0;
    const int from = std::max(since[i], first);
    const int regions = std::max(end - from, 0);
    const bool with_region = regions > 0 && from == 0;
    if (told[i] == Told::derived && !with_region) own = 0;
    const bool alone = !with_region && (own > 0 || told[i] == Told::as_numbers);
    const std::int64_t messages = regions + (alone ? 1 : 0);
    bytes += listeners_[i] * (messages * bare_[i] + own + regions * region_);
  }
  return bytes;
}

}  // namespace garrison::detail
