// SPDX-License-Identifier: Apache-2.0
// Everything a node is made of, read from its files and checked against each other.
#pragma once

#include "garrison/engine/agent.hpp"
#include "node/daemon/inputs.hpp"
#include "node/daemon/keys.hpp"
#include "node/daemon/roster.hpp"
#include "node/daemon/settings.hpp"

namespace garrison::node {

struct Station {
  Settings settings;
  Roster roster;
  Member self;
  Identity identity;
  std::vector<std::byte> part;
  std::unique_ptr<Agent> agent;
  Schedule schedule;
  Vector initial;
  Inputs inputs;
  Prologue run{};
  std::vector<Member> links;  ///< everybody it hears or is heard by, ascending ids
  std::vector<bool> listens;  ///< whether our messages go there
};

/// @throws IoError, InvalidInput: the first thing that does not fit
Station read_station(const std::string& path);

/// Refuses files that a node which runs by `now` could only follow after a restart: only [sensor], [log]
/// size_mb and files, and [state] every_s may differ. @throws InvalidInput
void require_same_run(const Station& now, const Station& next);

}  // namespace garrison::node
