// SPDX-License-Identifier: Apache-2.0
// garrison-ctl: what a running node says of itself, and what its log gives again.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <string>

#include "garrison/node/log.hpp"
#include "garrison/version.hpp"
#include "node/daemon/files.hpp"

using namespace garrison::node;

namespace {

constexpr const char* kUsage =
    "usage: garrison-ctl status|watch SOCKET\n"
    "       garrison-ctl replay LOG\n"
    "\n"
    "  status   everything a node says of itself, as a line of JSON\n"
    "  watch    a line a sample, until interrupted\n"
    "  replay   do again what a log says and compare every bit\n"
    "\n"
    "Exit codes: 0 fine, 1 the log gave something else, 2 refused.\n";

Descriptor connected(const std::string& path) {
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (path.size() >= sizeof to.sun_path) garrison::refuse(path, "a long path", "the socket of a node");
  std::memcpy(to.sun_path, path.data(), path.size());
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    refuse_file(path, "the socket of a running node ([socket].path in its node.toml)");
  return socket;
}

/// One line, or all of them.
int ask(const std::string& request, const std::string& path, bool once) {
  const Descriptor socket = connected(path);
  const std::string line = request + "\n";
  ::send(socket.get(), line.data(), line.size(), MSG_NOSIGNAL);
  char piece[4096];
  for (ssize_t got = 0; (got = ::read(socket.get(), piece, sizeof piece)) > 0;) {
    std::fwrite(piece, 1, static_cast<std::size_t>(got), stdout);
    std::fflush(stdout);
    if (once && std::memchr(piece, '\n', static_cast<std::size_t>(got)) != nullptr) return 0;
  }
  return once ? 2 : 0;
}

int replay(const std::string& path) {
  const LogReplay r = replay_log(read_bytes(path, std::size_t{4} << 30U));
  std::printf("%s: agent %d, %s, %lld calls, samples %lld..%lld, %lld estimates, %lld differ%s\n",
              path.c_str(), r.agent, r.family.c_str(), static_cast<long long>(r.calls),
              static_cast<long long>(r.first), static_cast<long long>(r.last),
              static_cast<long long>(r.estimates), static_cast<long long>(r.wrong),
              r.ended ? "" : "; the file has no end");
  return r.wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  if (count == 2 && std::string_view(words[1]) == "--version")
    return std::printf("garrison-ctl " GARRISON_VERSION "\n"), 0;
  if (count == 2 && std::string_view(words[1]) == "--help") return std::fputs(kUsage, stdout), 0;
  if (count != 3) return std::fputs(kUsage, stderr), 2;
  const std::string command = words[1];
  try {
    if (command == "status") return ask("status", words[2], true);
    if (command == "watch") return ask("watch", words[2], false);
    if (command == "replay") return replay(words[2]);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "garrison-ctl: %s\n", error.what()), 2;
  }
  return std::fprintf(stderr, "garrison-ctl: got \"%s\", expected status, watch or replay\n%s", words[1],
                      kUsage),
         2;
}
