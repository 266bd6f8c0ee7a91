// SPDX-License-Identifier: Apache-2.0
// Nodes of one family, FAMILY, from their parts of a design; linked to garrison::node alone.
#include <cstdio>
#include <cstring>
#include <garrison/engine/part.hpp>
#include <garrison/filters/families.hpp>

#include "agents.hpp"

using Family = garrison::FAMILY;

constexpr int n = states_of<Family>();

static std::vector<std::byte> read(const char* path) {
  std::vector<std::byte> all;
  if (std::FILE* file = std::fopen(path, "rb")) {
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) all.push_back(static_cast<std::byte>(c));
    std::fclose(file);
  }
  return all;
}

int main(int count, char** files) {
  std::vector<std::unique_ptr<garrison::Agent>> agents;
  for (int k = 1; k < count; ++k) {
    garrison::Refusal why{};
    auto part = read(files[k]);
    agents.push_back(garrison::agent_of_part<Family, n>(part, why));
    if (agents.back() == nullptr) {
      std::fprintf(stderr, "%s: %s\n", files[k], garrison::word(why).data());
      return 1;
    }
    part[part.size() / 2] ^= std::byte{1};
    if (garrison::agent_of_part<Family, n>(part, why) || why != garrison::Refusal::damaged) return 2;
  }
  return !agents.empty() && drive(agents) ? 0 : 3;
}
