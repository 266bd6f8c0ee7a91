// SPDX-License-Identifier: Apache-2.0
// garrison-ctl: what a running node says of itself, and what its log gives again.
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <string>

#include "garrison/node/log.hpp"
#include "garrison/node/statement.hpp"
#include "garrison/version.hpp"
#include "node/daemon/files.hpp"
#include "node/daemon/roster.hpp"
#include "node/programs/printed.hpp"

using namespace garrison::node;

namespace {

constexpr const char* kUsage =
    "usage: garrison-ctl status|watch|reload SOCKET\n"
    "       garrison-ctl replay LOG\n"
    "       garrison-ctl verify-proof PROOF ROSTER\n"
    "\n"
    "  status   everything a node says of itself, as a line of JSON\n"
    "  watch    a line a sample, until interrupted\n"
    "  reload   read node.toml again: [sensor], [log] size_mb and files, [state] every_s\n"
    "  replay   do again every call of a log and compare the estimates, bit by bit; samples in JSON, which "
    "are\n"
    "           for people, are not compared\n"
    "\n"
    "  verify-proof   whether a .proof convicts an agent of the roster\n"
    "\n"
    "Exit codes: 0 fine, 1 the log gave something else, or the proof proves nothing, 2 refused.\n";

Descriptor connected(const std::string& path) {
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (path.size() >= sizeof to.sun_path)
    garrison::refuse(path, "a path of " + std::to_string(path.size()) + " characters",
                     "the socket of a node: at most " + std::to_string(sizeof to.sun_path - 1));
  std::memcpy(to.sun_path, path.data(), path.size());
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    refuse_file(path, "the socket of a running node ([socket].path in its node.toml)");
  return socket;
}

Descriptor asked(const std::string& request, const std::string& path) {
  Descriptor socket = connected(path);
  if (request != "watch") {  // whose first sample may be far away
    const timeval patience{5, 0};
    ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  const std::string line = request + "\n";
  ::send(socket.get(), line.data(), line.size(), MSG_NOSIGNAL);
  return socket;
}

int no_answer(const std::string& path) {
  std::fprintf(stderr, "garrison-ctl: %s: got no answer in 5 s, expected one of a running node\n",
               path.c_str());
  return 2;
}

/// 2, with what the node says, when it does not take its files.
int reload(const std::string& path) {
  const Descriptor socket = asked("reload", path);
  std::string answer;
  char piece[4096];
  for (ssize_t got = 0;
       answer.find('\n') == std::string::npos && (got = ::read(socket.get(), piece, sizeof piece)) > 0;)
    answer.append(piece, static_cast<std::size_t>(got));
  if (answer.empty()) return no_answer(path);
  if (answer.starts_with(R"({"ok")")) return 0;
  return std::fprintf(stderr, "garrison-ctl: %s: not reloaded: %s", path.c_str(), answer.c_str()), 2;
}

/// One line, or all of them.
int ask(const std::string& request, const std::string& path, bool once) {
  const Descriptor socket = asked(request, path);
  char piece[4096];
  for (ssize_t got = 0; (got = ::read(socket.get(), piece, sizeof piece)) > 0;) {
    std::fwrite(piece, 1, static_cast<std::size_t>(got), stdout);
    if (std::fflush(stdout) != 0) return 0;  // `printed` says so
    if (once && std::memchr(piece, '\n', static_cast<std::size_t>(got)) != nullptr) return 0;
  }
  return once ? no_answer(path) : 0;
}

LogReplay replayed(const std::string& path) {
  try {
    return replay_log(read_bytes(path, std::size_t{4} << 30U));
  } catch (const garrison::InvalidInput& error) {
    throw garrison::InvalidInput(path + ": " + error.what());
  }
}

int replay(const std::string& path) {
  const LogReplay r = replayed(path);
  std::printf("%s: agent %d, %s, %lld calls, samples %lld..%lld, %lld estimates, %lld differ%s\n",
              path.c_str(), r.agent, r.family.c_str(), static_cast<long long>(r.calls),
              static_cast<long long>(r.first), static_cast<long long>(r.last),
              static_cast<long long>(r.estimates), static_cast<long long>(r.wrong),
              r.ended ? "" : "; the file has no end: the node was killed, or runs, or its disk was full");
  return r.wrong == 0 ? 0 : 1;
}

int verify(const std::string& path, const std::string& roster_path) {
  const auto proof = Proof::read(read_bytes(path));
  if (!proof) garrison::refuse(path, "no proof", "a file that garrison-node wrote into proofs/");
  const Roster roster = read_roster(roster_path);
  const Member* who = roster.find(int{proof->a.sender});
  if (who == nullptr)
    garrison::refuse(roster_path, "no agent " + std::to_string(proof->a.sender),
                     "the roster of the proof's run");
  const bool proved = proof->convicts(who->open);
  const auto n = [](std::int64_t v) { return static_cast<long long>(v); };
  std::printf(
      "%s: %s, agent %d, %s two different statements about samples %lld..%lld and %lld..%lld of its start "
      "%llu\n",
      path.c_str(), who->name.c_str(), who->id, proved ? "has signed" : "has NOT signed", n(proof->a.first),
      n(proof->a.last), n(proof->b.first), n(proof->b.last), static_cast<unsigned long long>(proof->a.boot));
  return proved ? 0 : 1;
}

int run(int count, char** words) {
  if (count == 2 && std::string_view(words[1]) == "--version")
    return std::printf("garrison-ctl " GARRISON_VERSION "\n"), 0;
  if (count == 2 && std::string_view(words[1]) == "--help") return std::fputs(kUsage, stdout), 0;
  if (count != 3 && !(count == 4 && std::string_view(words[1]) == "verify-proof"))
    return std::fputs(kUsage, stderr), 2;
  const std::string command = words[1];
  try {
    if (!start_crypto()) return std::fputs("garrison-ctl: the system has no random numbers\n", stderr), 2;
    if (command == "verify-proof" && count == 4) return verify(words[2], words[3]);
    if (command == "status") return ask("status", words[2], true);
    if (command == "reload") return reload(words[2]);
    if (command == "watch") return ask("watch", words[2], false);
    if (command == "replay") return replay(words[2]);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "garrison-ctl: %s\n", error.what()), 2;
  }
  return std::fprintf(stderr,
                      "garrison-ctl: got \"%s\", expected status, watch, reload, replay or verify-proof\n%s",
                      words[1], kUsage),
         2;
}

}  // namespace

int main(int count, char** words) { return printed("garrison-ctl", run(count, words)); }
