// SPDX-License-Identifier: Apache-2.0
#include "garrison/attacks/schedule.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace garrison {

Schedule::Schedule(std::vector<Phase> phases, std::int64_t stop, double probability)
    : phases_(std::move(phases)), stop_(stop), probability_(probability) {
  if (phases_.empty()) refuse("schedule", "no phase", "at least one (start, agents)");
  for (std::size_t k = 0; k < phases_.size(); ++k) {
    if (k > 0 && phases_[k].start <= phases_[k - 1].start)
      refuse("schedule[" + std::to_string(k) + "].start", std::to_string(phases_[k].start),
             "a time after " + std::to_string(phases_[k - 1].start), "list the phases in order of time");
    auto& agents = phases_[k].agents;
    std::sort(agents.begin(), agents.end());
    agents.erase(std::unique(agents.begin(), agents.end()), agents.end());
    if (!agents.empty() && agents.front() < 0)
      refuse("schedule[" + std::to_string(k) + "].agents", std::to_string(agents.front()), "agent ids >= 0");
  }
  if (stop_ <= phases_.back().start)
    refuse("stop", std::to_string(stop_), "a time after the start " + std::to_string(phases_.back().start));
  if (!(probability_ >= 0.0 && probability_ <= 1.0))
    refuse("probability", text(probability_), "a number in [0, 1]");
}

Schedule::Schedule(std::int64_t start, std::vector<int> agents, std::int64_t stop, double probability)
    : Schedule(std::vector<Phase>{{start, std::move(agents)}}, stop, probability) {}

std::span<const int> Schedule::agents(std::int64_t t) const {
  if (t >= stop_ || t < phases_.front().start) return {};
  std::size_t k = phases_.size() - 1;
  while (phases_[k].start > t) --k;
  return phases_[k].agents;
}

std::int64_t Schedule::since(std::int64_t t) const {
  if (t >= stop_ || t < phases_.front().start) return t;
  std::size_t k = phases_.size() - 1;
  while (phases_[k].start > t) --k;
  return phases_[k].start;
}

bool Schedule::strikes(const Random& random, std::int64_t t, int agent, std::uint32_t salt) const {
  return probability_ >= 1.0 || random.uniform(t, static_cast<std::uint32_t>(agent), salt) < probability_;
}

std::vector<int> Schedule::everyone() const {
  std::vector<int> all;
  for (const auto& phase : phases_) all.insert(all.end(), phase.agents.begin(), phase.agents.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void Schedule::require_agents_below(int agents) const {
  const auto all = everyone();
  if (!all.empty() && all.back() >= agents)
    refuse("attack.agents", std::to_string(all.back()), "ids in 0.." + std::to_string(agents - 1),
           "agents are numbered from 0");
}

}  // namespace garrison
