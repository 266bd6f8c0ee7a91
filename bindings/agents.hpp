// SPDX-License-Identifier: Apache-2.0
// Agents as Python holds them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "garrison/engine/agent.hpp"
#include "garrison/engine/design_file.hpp"

/// What an agent in Python is made of, so that it can be pickled: a whole design, or its part of one.
struct PyAgent {
  std::shared_ptr<const garrison::Prepared> prepared;  // null: from a part
  std::vector<std::byte> part;
  std::unique_ptr<garrison::Agent> agent;
  std::int64_t refused = 0;  // messages whose body was

  garrison::Agent* operator->() const { return agent.get(); }
  std::vector<std::byte> file() const {
    return prepared ? garrison::write_part(*prepared, agent->id()) : part;
  }
  std::vector<std::byte> snapshot() const {
    std::vector<std::byte> bytes(agent->snapshot_bytes());
    if (agent->save(bytes) == 0)
      garrison::refuse("agent", "an agent in the middle of a sample", "one between samples",
                       "call fuse " + garrison::amount(agent->rounds(), "time"));
    return bytes;
  }
};

inline PyAgent agent_from(const std::shared_ptr<const garrison::Prepared>& prepared, int id) {
  return {prepared, {}, prepared->agent(id)};
}
