// SPDX-License-Identifier: Apache-2.0
// garrison_node_fuzz [SECONDS [TARGET...]]: mutated bytes at every parser, for so long each (default 10). A
// plain loop with a seed, for where there is no libFuzzer; tools/fuzz.sh is for where there is.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.hpp"
#include "garrison/node/crypto.hpp"
#include "mutants.hpp"

using namespace garrison::node::test;

namespace {

void run(const std::string& name, const Target& target, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::mt19937_64 random(1);
  long long tried = 0, taken = 0;
  while (Clock::now() < end)
    for (int k = 0; k < 100; ++k, ++tried)
      taken += target.parse(mutated(target.seeds[random() % target.seeds.size()], random)) ? 1 : 0;
  std::printf("%-10s %10lld tried, %lld taken, the others refused\n", name.c_str(), tried, taken);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  const double seconds = count > 1 ? std::atof(words[1]) : 10.0;
  std::vector<std::string> names(words + std::min(count, 2), words + count);
  if (names.empty()) names = target_names();
  if (seconds <= 0 || !garrison::node::start_crypto())
    return std::fputs("usage: garrison_node_fuzz [SECONDS [TARGET...]]\n", stderr), 2;
  for (const std::string& name : names) {
    const auto target = target_of(name);
    if (target == nullptr) return std::fprintf(stderr, "garrison_node_fuzz: no target %s\n", name.c_str()), 2;
    run(name, *target, seconds);
  }
  return 0;
}
