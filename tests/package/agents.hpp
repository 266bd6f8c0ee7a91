// SPDX-License-Identifier: Apache-2.0
// What both sides of the comparison do with their agents; no exceptions, no run-time types.
#pragma once

#include <cstdio>
#include <garrison/engine/agent.hpp>
#include <memory>
#include <vector>

/// States of the agents of family F here.
template <class F>
constexpr int states_of() {
  if constexpr (requires { F::only_states; })
    return F::only_states;
  else
    return 4;
}

/// 50 samples of agents that hear each other, on measurements that every machine makes alike; prints every
/// agent's estimate, to the last bit. False when an agent refuses something.
inline bool drive(const std::vector<std::unique_ptr<garrison::Agent>>& agents) {
  const auto N = static_cast<int>(agents.size());
  struct Post {
    std::vector<std::byte> body;
    std::size_t size = 0;
  };
  std::vector<Post> posts(agents.size());
  for (std::size_t i = 0; i < agents.size(); ++i) posts[i].body.resize(agents[i]->most_bytes());
  const int start = static_cast<int>(agents[0]->start());
  for (int t = start + 1; t <= start + 50; ++t) {
    for (int i = 0; i < N; ++i) {
      garrison::Agent& agent = *agents[static_cast<std::size_t>(i)];
      Post& post = posts[static_cast<std::size_t>(i)];
      std::vector<double> y(static_cast<std::size_t>(agent.outputs()));
      for (std::size_t r = 0; r < y.size(); ++r) y[r] = (7 * t + 3 * i + 5 * static_cast<int>(r)) % 11 / 8.0;
      const auto sent = agent.sense(t, y, post.body);
      if (sent.refusal != garrison::Refusal::none) return false;
      post.size = sent.bytes;
    }
    for (int round = 0; round < agents[0]->rounds(); ++round) {
      for (const auto& agent : agents)
        for (const int j : agent->neighbours()) {
          const Post& post = posts[static_cast<std::size_t>(j)];
          if (post.size == 0) continue;
          const auto refusal = agent->deliver({j, t, round}, std::span(post.body).first(post.size));
          if (refusal != garrison::Refusal::none) return false;
        }
      for (std::size_t i = 0; i < agents.size(); ++i) {
        const auto sent = agents[i]->fuse(posts[i].body);
        if (sent.refusal != garrison::Refusal::none) return false;
        posts[i].size = sent.bytes;
      }
    }
  }
  for (const auto& agent : agents) {
    std::vector<double> x(static_cast<std::size_t>(agent->states()));
    agent->estimate(x);
    std::printf("%s %d:", agent->family().data(), agent->id());
    for (const double v : x) std::printf(" %a", v);
    const garrison::Report report = agent->report();
    std::printf("  bound %a, verdict %d\n", report.bound, static_cast<int>(report.verdict));
  }
  return true;
}
