// SPDX-License-Identifier: Apache-2.0
// On the board: agents from the files of `design`, one PART each, linked to garrison::node alone. A board has
// one of them; here all five run side by side, so that they have somebody to talk to.
#include <cstdio>
#include <garrison/engine/part.hpp>
#include <garrison/filters/saturation/filter.hpp>

#include "exchange.hpp"

static std::vector<std::byte> read(const char* path) {
  std::vector<std::byte> all;
  if (std::FILE* file = std::fopen(path, "rb")) {
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) all.push_back(static_cast<std::byte>(c));
    std::fclose(file);
  }
  return all;
}

int main(int count, char** parts) {
  std::vector<std::unique_ptr<garrison::Agent>> agents;
  for (int k = 1; k < count; ++k) {
    garrison::Refusal why{};
    agents.push_back(garrison::agent_of_part<garrison::Saturation, 2>(read(parts[k]), why));
    if (agents.back() == nullptr) {
      std::fprintf(stderr, "%s: %s\n", parts[k], garrison::word(why).data());
      return 1;
    }
  }
  if (agents.empty()) return 2;
  std::vector<Post> posts;
  for (std::int64_t t = 1; t <= 30; ++t) {
    std::vector<std::vector<double>> y;
    for (std::size_t i = 0; i < agents.size(); ++i) y.push_back({i % 2 == 0 ? 1.0 : 0.5});
    if (!sample(agents, t, y, posts)) return 1;
  }
  for (const auto& agent : agents) {
    double x[2];
    agent->estimate(x);
    std::printf("agent %d: a message has at most %zu bytes; after 30 samples %.3f %.3f\n", agent->id(),
                agent->most_bytes(), x[0], x[1]);
  }
}
