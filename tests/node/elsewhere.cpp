// SPDX-License-Identifier: Apache-2.0
// Replays logs of saturation agents of two states: headers, journal and log alone, for any processor.
#include <cstdio>

#include "garrison/engine/part.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/node/log.hpp"

using namespace garrison;

namespace {

std::vector<std::byte> read(const char* path) {
  std::vector<std::byte> all;
  if (std::FILE* file = std::fopen(path, "rb")) {
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) all.push_back(static_cast<std::byte>(c));
    std::fclose(file);
  }
  return all;
}

}  // namespace

/// Prints one line for all; 1 when a bit differs.
int main(int count, char** logs) {
  long long estimates = 0, wrong = 0;
  for (int k = 1; k < count; ++k) {
    const auto log = read(logs[k]);
    const node::LogReplay r = node::replay_log(log, [](node::Bytes part) {
      Refusal why{};
      return agent_of_part<Saturation, 2>(part, why);
    });
    estimates += r.estimates;
    wrong += r.wrong;
  }
  std::printf("%d logs, %lld estimates, %lld differ\n", count - 1, estimates, wrong);
  return estimates > 0 && wrong == 0 ? 0 : 1;
}
