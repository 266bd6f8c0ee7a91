// SPDX-License-Identifier: Apache-2.0
// The thread that estimates: sockets, clock and node, nothing else. After `begin` it takes no memory from the
// heap and opens no file; what has to be kept goes through the ring to the other thread.
#pragma once

#include <atomic>

#include "node/daemon/ring.hpp"
#include "node/daemon/sensor.hpp"
#include "node/daemon/service.hpp"
#include "node/daemon/station.hpp"
#include "node/daemon/status.hpp"

namespace garrison::node {

/// Records in the ring.
enum class Note : std::uint8_t {
  call,      ///< wall time i64, entry
  status,    ///< Status
  snapshot,  ///< bytes of a snapshot
  fresh,     ///< a new log begins here
  proof,     ///< somebody has signed two things: Proof
};

/// The system's random numbers.
class SystemRandom final : public Random {
 public:
  Key key() noexcept override { return random_seed(); }
};

class Loop final : private World {
 public:
  /// Keeps references to all but `boot`.
  Loop(Station& station, std::uint64_t boot, Udp& udp, const Sensor& sensor, Ring& ring);

  /// How the node begins: from a snapshot, with the network before its first sample, or by listening. False
  /// when there is a snapshot that the agent does not take: then as without it.
  bool begin(Bytes snapshot);
  void run() noexcept;
  /// From the other thread. Ends after the sample that is under way.
  void end() noexcept { ending_.store(true); }
  /// From the other thread: measurements come from here now. The sensor before may be used until the loop has
  /// turned twice.
  void use(const Sensor& sensor) noexcept { sensor_.store(&sensor); }
  /// Before `run`: a liar, for tests of a network.
  void tamper_with(Tamper& tamper) noexcept { node_.tamper_with(tamper); }
  /// From the other thread: the log has to begin anew.
  void ask_fresh() noexcept { fresh_wanted_.store(true); }
  /// It has ended by itself, or as it was told to.
  bool over() const noexcept { return over_.load(); }
  /// Grows while the loop turns.
  std::uint64_t turns() const noexcept { return turns_.load(std::memory_order_relaxed); }

 private:
  void send(int neighbour, Bytes datagram) noexcept override;
  void measure(std::int64_t sample, std::span<double> y) noexcept override;
  void journal(const Entry& entry) noexcept override;
  void ended(const Sample& sample) noexcept override;
  void contradiction(const Statement& a, const Statement& b) noexcept override;

  void turn() noexcept;
  void wait() noexcept;
  bool may_end() const noexcept;
  void keep_early(const Entry& entry) noexcept;
  void note(const Entry& entry) noexcept;
  void put_snapshot() noexcept;
  void put_status(const Sample* sample) noexcept;

  Station& station_;
  Udp& udp_;
  std::atomic<const Sensor*> sensor_;
  Ring& ring_;
  SystemRandom random_;
  Instant now_;
  Authors authors_;
  Node node_;
  StatusHead head_;
  std::vector<std::byte> status_;
  std::vector<std::byte> snapshot_;
  std::vector<std::byte> entry_;
  std::vector<std::byte> early_;  ///< deliveries of the next sample: no snapshot has them
  std::size_t early_size_ = 0;
  bool broken_ = false;  ///< a call did not fit into the ring
  Micros snapshot_at_ = 0;
  Micros status_at_ = 0;
  Micros end_by_ = 0;
  std::atomic<bool> ending_{false};
  std::atomic<bool> over_{false};
  std::atomic<bool> fresh_wanted_{false};
  std::atomic<std::uint64_t> turns_{0};
};

}  // namespace garrison::node
