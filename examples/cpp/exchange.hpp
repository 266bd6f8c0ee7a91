// SPDX-License-Identifier: Apache-2.0
// One sample of agents that hear each other. On a node there is one agent, and a link where the posts are.
#pragma once

#include <cstdint>
#include <garrison/engine/agent.hpp>
#include <memory>
#include <span>
#include <vector>

/// What an agent has to send; no bytes: nothing.
struct Post {
  std::vector<std::byte> room;
  std::size_t bytes = 0;
};

/// Sample t with y[i] measured by agent i, and all its rounds. False when an agent refuses a call.
inline bool sample(std::span<const std::unique_ptr<garrison::Agent>> agents, std::int64_t t,
                   std::span<const std::vector<double>> y, std::vector<Post>& posts) {
  using garrison::Refusal;
  posts.resize(agents.size());
  for (std::size_t i = 0; i < agents.size(); ++i) {
    posts[i].room.resize(agents[i]->most_bytes());
    const auto sent = agents[i]->sense(t, y[i], posts[i].room);
    if (sent.refusal != Refusal::none) return false;
    posts[i].bytes = sent.bytes;
  }
  for (int round = 0; round < agents[0]->rounds(); ++round) {
    for (const auto& agent : agents)
      for (const int j : agent->neighbours()) {
        const Post& post = posts[static_cast<std::size_t>(j)];
        if (post.bytes == 0) continue;
        if (agent->deliver({j, t, round}, std::span(post.room).first(post.bytes)) != Refusal::none)
          return false;
      }
    for (std::size_t i = 0; i < agents.size(); ++i) {
      const auto sent = agents[i]->fuse(posts[i].room);
      if (sent.refusal != Refusal::none) return false;
      posts[i].bytes = sent.bytes;
    }
  }
  return true;
}
