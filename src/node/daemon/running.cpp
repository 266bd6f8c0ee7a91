// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/running.hpp"

#include <sched.h>
#include <signal.h>

#include <bit>
#include <thread>

#include "node/daemon/desk.hpp"
#include "node/daemon/service.hpp"
#include "node/daemon/state.hpp"

namespace garrison::node {

namespace {

/// Room for what the desk is late with: 64 samples, and half a mebibyte at least.
std::size_t ring_size(const Station& station) {
  const Agent& agent = *station.agent;
  const std::size_t call = 64 + agent.most_bytes();
  const std::size_t calls = static_cast<std::size_t>(agent.rounds()) * (1 + agent.neighbours().size());
  const std::size_t status = sizeof(StatusHead) + station.links.size() * sizeof(LinkStatus);
  const std::size_t numbers = 8 * static_cast<std::size_t>(2 * agent.states() + agent.outputs());
  const std::size_t sample = calls * call + status + numbers + agent.snapshot_bytes();
  return std::bit_ceil(std::max<std::size_t>(1 << 19, 64 * sample));
}

/// Until the kernel holds the clock for synchronised, or a signal comes; false then.
bool wait_for_clock(const Settings& settings, Desk& desk) {
  if (!settings.require_synchronised || clock_synchronised()) return true;
  say(Priority::warning, "the clock is not synchronised; waiting ([clock].require_synchronised)");
  notify("STATUS=no clock");
  return desk.wait_until(clock_synchronised);
}

void require_inputs_now(const Station& station) {
  const std::int64_t slot = station.schedule.slot(now().wall);
  if (slot > station.inputs.last())
    refuse(station.settings.inputs, amount(station.inputs.last(), "row"),
           std::to_string(slot) + " at least: the run is at that sample",
           "the inputs of the whole run, the same on all nodes");
}

/// With what the last life left; where that cannot be used, with a word, as without it.
void begin(Loop& loop, Desk& desk, const Station& station) {
  const std::string& folder = station.settings.state_folder;
  const bool kept = has_state(folder);
  const auto found = read_state(folder, station.run);
  const bool taken = loop.begin(found.value_or(std::vector<std::byte>{}));
  if (!kept || (found && taken)) return;
  desk.count_refused_state();
  say(Priority::warning, folder + "/state: got " +
                             (found ? "that of another node of this run, or of another version"
                                    : "a file that is damaged or of another run") +
                             ", expected what this node left; it starts without it");
}

/// The loop in its thread, which ends with this, however that comes.
class Estimating {
 public:
  explicit Estimating(Loop& loop) : loop_(loop), thread_([&loop] { loop.run(); }) {}
  ~Estimating() {
    loop_.end();
    thread_.join();
  }
  Estimating(const Estimating&) = delete;
  Estimating& operator=(const Estimating&) = delete;

 private:
  Loop& loop_;
  std::thread thread_;
};

}  // namespace

void block_signals() {
  const sigset_t watched = node_signals();
  ::sigprocmask(SIG_BLOCK, &watched, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is a disk that is full
}

void run_node(Station& station, bool print, Tamper* tamper) {
  const Settings& settings = station.settings;
  make_folder(settings.state_folder);
  const std::uint64_t boot = next_boot(settings.state_folder);
  Udp udp(settings.file + ", [listen].address", settings.listen, settings.receive_buffer);
  auto sensor = std::make_unique<Sensor>(settings.sensor, static_cast<std::size_t>(station.agent->outputs()),
                                         settings.file);
  Ring ring(ring_size(station));
  Desk desk(station, boot, std::move(sensor), ring, print);
  Loop loop(station, boot, udp, desk.sensor(), ring);
  if (tamper != nullptr) loop.tamper_with(*tamper);
  notify("READY=1");
  if (!wait_for_clock(settings, desk)) return;
  require_inputs_now(station);
  begin(loop, desk, station);
  {
    const Estimating estimating(loop);
    const sched_param usual{};
    ::sched_setscheduler(0, SCHED_OTHER, &usual);  // files wait, estimates do not
    desk.run(loop);
    notify("STOPPING=1");
  }
  desk.drain();
  desk.save_state();
}

}  // namespace garrison::node
