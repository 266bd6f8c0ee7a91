// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/channel.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>

#include "garrison/kernel/chances.hpp"

namespace garrison {
namespace {

void require_probability(const char* which, double value) {
  if (!(value >= 0.0 && value <= 1.0)) refuse(which, text(value), "a probability in [0, 1]");
}
void require_agent(const std::string& which, int id, int least, int agents) {
  if (id < least || id >= agents)
    refuse(which, "agent " + std::to_string(id), "an agent in 0.." + std::to_string(agents - 1));
}

void require_link(const char* which, const Network& network, int sender, int receiver) {
  const auto heard = network.neighbours(receiver);
  if (!std::binary_search(heard.begin(), heard.end(), sender))
    refuse(which, "the link from " + std::to_string(sender) + " to " + std::to_string(receiver),
           "a link of the network");
}

class Scheduled final : public Channel {
 public:
  explicit Scheduled(std::vector<Cut> cuts) : cuts_(std::move(cuts)) {}
  void decide(std::int64_t sample, int, const Links& links, std::span<Fate> fates) const override {
    for (const Cut& cut : cuts_) {
      if (sample < cut.start || sample >= cut.stop) continue;
      for (std::size_t e = 0; e < fates.size(); ++e)
        if ((cut.sender < 0 || cut.sender == links.senders[e]) &&
            (cut.receiver < 0 || cut.receiver == links.receivers[e]) && fates[e] == Fate::delivered)
          fates[e] = Fate::lost;
    }
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
  void decide(std::int64_t sample, int round, const Links& links, std::span<Fate> fates) const override {
    const auto [first, last] =
        std::equal_range(keys_.begin(), keys_.end(), Key{sample, round, 0, 0}, earlier);
    if (first == last) return;
    for (std::size_t e = 0; e < fates.size(); ++e)
      if (fates[e] == Fate::delivered &&
          std::binary_search(first, last, Key{sample, round, links.senders[e], links.receivers[e]}))
        fates[e] = Fate::lost;
  }

 private:
  using Key = std::tuple<std::int64_t, int, int, int>;
  static Key key(const Envelope& m, int receiver) { return {m.sample, m.round, m.sender, receiver}; }
  static bool earlier(const Key& a, const Key& b) {
    return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
  }
  std::vector<Key> keys_;
};

}  // namespace

SeededFaults::SeededFaults(double drop, double delay, std::uint64_t seed, std::uint32_t trial)
    : drop_(drop), delay_(delay), random_(seed, trial, Purpose::link) {
  require_probability("link.drop", drop);
  require_probability("link.delay", delay);
}

void SeededFaults::decide(std::int64_t sample, int round, const Links& links, std::span<Fate> fates) const {
  constexpr std::size_t most = 256;
  std::array<std::uint32_t, most> address;
  std::array<std::uint8_t, most> happens;
  for (std::size_t first = 0; first < fates.size(); first += most) {
    const std::size_t count = std::min(most, fates.size() - first);
    for (std::size_t e = 0; e < count; ++e)
      address[e] = static_cast<std::uint32_t>(links.senders[first + e]) * 65537U +
                   static_cast<std::uint32_t>(links.receivers[first + e]);
    const auto strike = [&](double probability, std::uint32_t index, Fate fate) {
      if (probability <= 0.0) return;
      happen(random_, sample, address.data(), index, probability, count, happens.data());
      for (std::size_t e = 0; e < count; ++e) {
        Fate& known = fates[first + e];
        known = happens[e] != 0 && known == Fate::delivered ? fate : known;
      }
    };
    const auto index = 2U * static_cast<std::uint32_t>(round);
    strike(drop_, index, Fate::lost);
    strike(delay_, index + 1, Fate::late);
  }
}

std::unique_ptr<Channel> scheduled_faults(const Network& network, std::vector<Cut> cuts) {
  for (const Cut& cut : cuts) {
    require_agent("link.cuts", cut.sender, -1, network.agents());
    require_agent("link.cuts", cut.receiver, -1, network.agents());
    if (cut.sender >= 0 && cut.receiver >= 0) require_link("link.cuts", network, cut.sender, cut.receiver);
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
    require_link("link.lost", network, one.message.sender, one.receiver);
  }
  return std::make_unique<Recorded>(std::move(lost));
}

}  // namespace garrison
