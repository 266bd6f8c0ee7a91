// SPDX-License-Identifier: Apache-2.0
// garrison-node: one agent of a network. docs/node.md.
#include <cstdio>
#include <cstring>

#include "garrison/version.hpp"
#include "node/daemon/running.hpp"
#include "node/daemon/service.hpp"
#include "node/programs/printed.hpp"

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
    "SIGTERM and SIGINT end it; SIGHUP lets a service read its files anew, as garrison-ctl reload does.\n"
    "Exit codes: 0 ended by a signal or with its known inputs (or --check found nothing), 2 a file or the\n"
    "command line was refused, or nobody takes what is printed.\n";

void print_station(const Station& s) {
  std::printf("%s: agent %d of %d, %s, %d rounds every %.6g ms, %zu neighbours, first sample at %.6f\n",
              s.settings.file.c_str(), s.agent->id(), s.agent->agents(),
              std::string(s.agent->family()).c_str(), s.agent->rounds(),
              static_cast<double>(s.schedule.period) / 1e3, s.links.size(),
              static_cast<double>(s.schedule.begin(s.agent->start() + 1)) / 1e6);
}

int run(int count, char** words) {
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
    if (check) return print_station(station), 0;
    run_node(station, print);
    return 0;
  } catch (const std::exception& error) {
    say(Priority::error, error.what());
    return 2;
  }
}

}  // namespace

int main(int count, char** words) { return printed("garrison-node", run(count, words)); }
