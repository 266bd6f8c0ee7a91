// SPDX-License-Identifier: Apache-2.0
// garrison-keygen FILE: a new key into FILE, its public half for the roster onto standard output.
#include <cstdio>
#include <string_view>

#include "garrison/version.hpp"
#include "node/daemon/keys.hpp"
#include "node/programs/printed.hpp"

using namespace garrison::node;

namespace {
constexpr const char* kUsage =
    "usage: garrison-keygen [--show] FILE\n"
    "\n"
    "  Writes a new key into FILE (mode 0600, never over an old one) and prints the line for the roster.\n"
    "  --show   print the line of the key that is there\n"
    "\n"
    "Exit codes: 0 fine, 2 refused.\n";

int run(int count, char** words) {
  const char* file = nullptr;
  bool show = false;
  for (int k = 1; k < count; ++k) {
    const std::string_view word = words[k];
    if (word == "--version") return std::printf("garrison-keygen " GARRISON_VERSION "\n"), 0;
    if (word == "--help" || word == "-h") return std::fputs(kUsage, stdout), 0;
    if (word == "--show")
      show = true;
    else if (word.starts_with("-") || file != nullptr)
      return std::fprintf(stderr, "garrison-keygen: got \"%s\", expected one FILE\n%s", words[k], kUsage), 2;
    else
      file = words[k];
  }
  if (file == nullptr) return std::fputs(kUsage, stderr), 2;
  if (!start_crypto()) return std::fputs("garrison-keygen: the system has no random numbers\n", stderr), 2;
  try {
    const Identity identity = show ? read_key(file) : identity_of(random_seed());
    if (!show) write_key(file, identity);
    std::printf("key = \"%s\"\n", base64(identity.open).c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "garrison-keygen: %s\n", error.what());
    return 2;
  }
}

}  // namespace

int main(int count, char** words) { return printed("garrison-keygen", run(count, words)); }
