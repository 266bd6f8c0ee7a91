// SPDX-License-Identifier: Apache-2.0
// What becomes of messages between honest agents: the one interface that stands for a network.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "garrison/core/envelope.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/random.hpp"

namespace garrison {

/// Late messages are lost to their receiver, as on a node: a driver delivers only what is of the present
/// sample and round. They are counted apart.
enum class Fate : std::uint8_t { delivered, lost, late };

/// The links of a network: link e leads from senders[e] to receivers[e].
struct Links {
  std::span<const int> senders;
  std::span<const int> receivers;
};

/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Channel {
 public:
  virtual ~Channel() = default;
  /// fates[e]: of what link e carries in this round; changes those that are `delivered` so far.
  virtual void decide(std::int64_t sample, int round, const Links& links, std::span<Fate> fates) const = 0;
};

/// Messages from `sender` to `receiver` (-1: from all, to all) are lost at samples start <= t < stop.
struct Cut {
  int sender = -1;
  int receiver = -1;
  std::int64_t start = 0;
  std::int64_t stop = INT64_MAX;
};
/// One message that did not arrive.
struct Lost {
  Envelope message;
  int receiver = 0;
};

/// Every message meets its fate independently; drop and delay are probabilities in [0, 1]. The result depends
/// on sample, round, sender, receiver, seed and trial only.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT SeededFaults final : public Channel {
 public:
  /// @throws InvalidInput when a probability is outside [0, 1]
  SeededFaults(double drop, double delay, std::uint64_t seed, std::uint32_t trial);
  bool any() const { return drop_ > 0.0 || delay_ > 0.0; }
  void decide(std::int64_t sample, int round, const Links& links, std::span<Fate> fates) const override;

 private:
  double drop_;
  double delay_;
  Random random_;
};

/// Scheduled faults. @throws InvalidInput when an agent does not exist or a cut ends before it starts
GARRISON_EXPORT std::unique_ptr<Channel> scheduled_faults(const Network& network, std::vector<Cut> cuts);
/// Recorded faults: just these are lost. @throws InvalidInput when an agent does not exist
GARRISON_EXPORT std::unique_ptr<Channel> recorded_faults(const Network& network, std::vector<Lost> lost);

}  // namespace garrison
