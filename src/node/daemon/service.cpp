// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/service.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/timex.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "node/daemon/files.hpp"

namespace garrison::node {

void notify(const std::string& line) noexcept {
  const char* path = std::getenv("NOTIFY_SOCKET");
  if (path == nullptr) return;
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  const std::size_t size = std::strlen(path);
  if (size < 2 || size >= sizeof to.sun_path) return;
  std::memcpy(to.sun_path, path, size);
  if (path[0] == '@') to.sun_path[0] = '\0';  // of the abstract namespace
  const Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ::sendto(socket.get(), line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&to),
           static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + size));
}

namespace {
/// Standard error is the stream that the service manager named: device:inode (systemd.exec(5)).
bool journal_reads() {
  const char* named = std::getenv("JOURNAL_STREAM");
  struct stat stream{};
  if (named == nullptr || ::fstat(STDERR_FILENO, &stream) != 0) return false;
  return std::to_string(stream.st_dev) + ":" + std::to_string(stream.st_ino) == named;
}
}  // namespace

void say(Priority priority, const std::string& what) {
  static const bool with_priority = journal_reads();
  if (with_priority) std::fprintf(stderr, "<%d>", static_cast<int>(priority));
  std::fprintf(stderr, "garrison-node: %s\n", what.c_str());
}

sigset_t ending_signals() noexcept {
  sigset_t both;
  sigemptyset(&both);
  sigaddset(&both, SIGTERM);
  sigaddset(&both, SIGINT);
  return both;
}

sigset_t node_signals() noexcept {
  sigset_t all = ending_signals();
  sigaddset(&all, SIGHUP);
  return all;
}

Micros watchdog_pause() noexcept {
  const char* micros = std::getenv("WATCHDOG_USEC");
  const char* process = std::getenv("WATCHDOG_PID");
  if (micros == nullptr || (process != nullptr && std::atol(process) != ::getpid())) return 0;
  return std::atoll(micros) / 2;
}

Instant now() noexcept {
  const auto at = [](clockid_t clock) {
    timespec t{};
    ::clock_gettime(clock, &t);
    return Micros{t.tv_sec} * 1'000'000 + t.tv_nsec / 1000;
  };
  return {at(CLOCK_REALTIME), at(CLOCK_MONOTONIC)};
}

bool clock_synchronised() noexcept {
  timex state{};
  const int found = ::adjtimex(&state);
  return found >= 0 && found != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
}

}  // namespace garrison::node
