// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/channel.hpp"

#include <algorithm>
#include <string>
#include <tuple>

namespace garrison {
namespace {

void require_probability(const char* which, double value) {
  if (!(value >= 0.0 && value <= 1.0)) refuse(which, text(value), "a probability in [0, 1]");
}
void require_agent(const std::string& which, int id, int least, int agents) {
  if (id < least || id >= agents)
    refuse(which, "agent " + std::to_string(id), "an agent in 0.." + std::to_string(agents - 1));
}

class Scheduled final : public Channel {
 public:
  explicit Scheduled(std::vector<Cut> cuts) : cuts_(std::move(cuts)) {}
  Fate fate(const Envelope& m, int receiver) const override {
    for (const Cut& cut : cuts_)
      if ((cut.sender < 0 || cut.sender == m.sender) && (cut.receiver < 0 || cut.receiver == receiver) &&
          m.sample >= cut.start && m.sample < cut.stop)
        return Fate::lost;
    return Fate::delivered;
  }

 private:
  std::vector<Cut> cuts_;
};

class Recorded final : public Channel {
 public:
  explicit Recorded(std::vector<Lost> lost) {
    for (const Lost& one : lost) keys_.push_back(key(one.message, one.receiver));
    std::sort(keys_.begin(), keys_.end());
  }
  Fate fate(const Envelope& m, int receiver) const override {
    return std::binary_search(keys_.begin(), keys_.end(), key(m, receiver)) ? Fate::lost : Fate::delivered;
  }

 private:
  using Key = std::tuple<std::int64_t, int, int, int>;
  static Key key(const Envelope& m, int receiver) { return {m.sample, m.round, m.sender, receiver}; }
  std::vector<Key> keys_;
};

}  // namespace

SeededFaults::SeededFaults(double drop, double delay, std::uint64_t seed, std::uint32_t trial)
    : drop_(drop), delay_(delay), random_(seed, trial, Purpose::link) {
  require_probability("link.drop", drop);
  require_probability("link.delay", delay);
}

std::unique_ptr<Channel> scheduled_faults(const Network& network, std::vector<Cut> cuts) {
  for (const Cut& cut : cuts) {
    require_agent("link.cuts", cut.sender, -1, network.agents());
    require_agent("link.cuts", cut.receiver, -1, network.agents());
    if (cut.stop < cut.start)
      refuse("link.cuts",
             "a cut from sample " + std::to_string(cut.start) + " to " + std::to_string(cut.stop),
             "a start that is not after the end");
  }
  return std::make_unique<Scheduled>(std::move(cuts));
}

std::unique_ptr<Channel> recorded_faults(const Network& network, std::vector<Lost> lost) {
  for (const Lost& one : lost) {
    require_agent("link.lost", one.message.sender, 0, network.agents());
    require_agent("link.lost", one.receiver, 0, network.agents());
  }
  return std::make_unique<Recorded>(std::move(lost));
}

}  // namespace garrison
