// SPDX-License-Identifier: Apache-2.0
// garrison-node: one agent of a network. docs/node.md.
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>

#include <cstdio>
#include <cstring>
#include <thread>

#include "garrison/version.hpp"
#include "node/daemon/desk.hpp"
#include "node/daemon/state.hpp"

using namespace garrison;
using namespace garrison::node;

namespace {

constexpr const char* kUsage =
    "usage: garrison-node [--check | --print] FILE\n"
    "\n"
    "  FILE      node.toml\n"
    "  --check   read all files, say whether they fit, and end\n"
    "  --print   a line of JSON a sample on standard output\n"
    "  --version\n"
    "\n"
    "Exit codes: 0 ended by a signal (or --check found nothing), 2 a file or the command line was refused.\n";
constexpr std::size_t kRing = 4 << 20;

void block_signals() {
  const sigset_t ending = ending_signals();
  ::sigprocmask(SIG_BLOCK, &ending, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
}

/// Until the kernel holds the clock for synchronised, or a signal comes; false then.
bool wait_for_clock(const Settings& settings) {
  if (!settings.require_synchronised || clock_synchronised()) return true;
  std::fprintf(stderr,
               "<4>garrison-node: the clock is not synchronised; waiting ([clock].require_synchronised)\n");
  notify("STATUS=no clock");
  const sigset_t ending = ending_signals();
  const timespec pause{0, 200'000'000};
  while (!clock_synchronised()) {
    if (::sigtimedwait(&ending, nullptr, &pause) > 0) return false;
    notify("WATCHDOG=1");
  }
  return true;
}

void say(const Station& s) {
  std::printf("%s: agent %d of %d, %s, %d rounds every %.6g ms, %zu neighbours, first sample at %.6f\n",
              s.settings.file.c_str(), s.agent->id(), s.agent->agents(),
              std::string(s.agent->family()).c_str(), s.agent->rounds(),
              static_cast<double>(s.schedule.period) / 1e3, s.links.size(),
              static_cast<double>(s.schedule.begin(s.agent->start() + 1)) / 1e6);
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

void run(Station& station, bool print) {
  const Settings& settings = station.settings;
  make_folder(settings.state_folder);
  const std::uint64_t boot = next_boot(settings.state_folder);
  Udp udp(settings.file + ", [listen].address", settings.listen, settings.receive_buffer);
  Sensor sensor(settings.sensor, static_cast<std::size_t>(station.agent->outputs()), settings.file);
  Ring ring(kRing);
  Desk desk(station, boot, sensor, ring, print);
  Loop loop(station, boot, udp, sensor, ring);
  notify("READY=1");
  if (!wait_for_clock(settings)) return;
  loop.begin(read_state(settings.state_folder, station.run).value_or(std::vector<std::byte>{}));
  {
    const Estimating estimating(loop);
    ::mlockall(MCL_CURRENT | MCL_ONFAULT);  // where it is allowed
    const sched_param usual{};
    ::sched_setscheduler(0, SCHED_OTHER, &usual);  // files wait, estimates do not
    desk.run(loop);
    notify("STOPPING=1");
  }
  desk.drain();
  desk.save_state();
}

}  // namespace

int main(int count, char** words) {
  const char* file = nullptr;
  bool check = false, print = false;
  for (int k = 1; k < count; ++k) {
    const std::string_view word = words[k];
    if (word == "--version") return std::printf("garrison-node " GARRISON_VERSION "\n"), 0;
    if (word == "--help" || word == "-h") return std::fputs(kUsage, stdout), 0;
    if (word == "--check")
      check = true;
    else if (word == "--print")
      print = true;
    else if (word.starts_with("-") || file != nullptr)
      return std::fprintf(stderr, "garrison-node: got \"%s\", expected one FILE\n%s", words[k], kUsage), 2;
    else
      file = words[k];
  }
  if (file == nullptr) return std::fputs(kUsage, stderr), 2;
  block_signals();
  if (!start_crypto()) return std::fputs("garrison-node: the system has no random numbers\n", stderr), 2;
  try {
    Station station = read_station(file);
    if (check) return say(station), 0;
    run(station, print);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "<3>garrison-node: %s\n", error.what());
    return 2;
  }
}
