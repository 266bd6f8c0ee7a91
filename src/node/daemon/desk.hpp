// SPDX-License-Identifier: Apache-2.0
// The thread beside the loop: sensors, files, the local socket, and what the service manager is told. It may
// be late; the loop never waits for it.
#pragma once

#include <unistd.h>

#include <functional>
#include <memory>
#include <optional>

#include "node/daemon/local_socket.hpp"
#include "node/daemon/log_keeper.hpp"
#include "node/daemon/loop.hpp"

namespace garrison::node {

/// The answer to a request that was done.
inline constexpr const char* kOk = R"({"ok":true})";

class Desk {
 public:
  /// Keeps references. print: a line a sample on standard output. @throws IoError
  Desk(Station& station, std::uint64_t boot, std::unique_ptr<Sensor> sensor, Ring& ring, bool print);
  const Sensor& sensor() const noexcept { return *sensor_; }

  /// Serves clients until `ready`; false where a signal ended the node before.
  bool wait_until(const std::function<bool()>& ready);
  /// What an earlier life left is not taken.
  void count_refused_state() noexcept { ++around_.states_refused; }
  /// Until a signal comes or the loop is over; it is told to end, and what it leaves is written.
  void run(Loop& loop);
  /// What came through the ring, to files and clients.
  void drain();
  /// The last snapshot onto the disk.
  void save_state();

 private:
  bool ended(int signals);
  void wait(int signals, int milliseconds);
  void tick(Micros steady);
  void record(Note note, Bytes content);
  void status(Bytes content);
  void snapshot(Bytes content);
  void proof(Bytes content);
  void begin_log();
  void lose_log(const std::string& why);
  void flush_log();
  std::string answer(std::string_view request);
  std::string measured(std::string_view line);
  std::string reload();
  void watch_over(Micros steady);

  Station& station_;
  Loop* loop_ = nullptr;
  std::unique_ptr<Sensor> sensor_;
  std::unique_ptr<Sensor> former_;  ///< of before a reload, as long as the loop may look at it
  std::uint64_t former_until_ = 0;  ///< turn of the loop
  Ring& ring_;
  bool print_;
  bool by_hand_ = ::isatty(STDERR_FILENO) != 0;  ///< asked at the start: a terminal that is gone is none
  std::optional<LogKeeper> log_;
  std::unique_ptr<Agent> mirror_;  ///< loads snapshots, to be asked what the loop has no time for
  std::unique_ptr<LocalSocket> socket_;
  std::vector<std::byte> room_;
  std::vector<std::byte> snapshot_;
  Surroundings around_;
  Status status_;
  bool known_ = false;
  Micros snapshot_at_ = -1;
  Micros stored_at_ = -1;  ///< of the one on the disk
  bool log_lost_ = false;  ///< the present file has a hole, or the next could not be begun
  bool log_said_ = false;  ///< so, and no file has been whole since
  Micros saved_at_ = 0;
  Micros flushed_at_ = 0;
  Micros watched_at_ = 0;
  Micros settles_at_ = 0;  ///< 0: it has
  std::uint64_t turns_seen_ = 0;
  bool failing_ = false;  ///< the disk takes no state: said once
};

}  // namespace garrison::node
