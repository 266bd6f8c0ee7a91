// SPDX-License-Identifier: Apache-2.0
// Who takes part and when: one file, the same on all nodes of a run.
#pragma once

#include <string>
#include <vector>

#include "garrison/node/core.hpp"
#include "garrison/node/peer.hpp"
#include "node/daemon/udp.hpp"

namespace garrison::node {

struct Member {
  int id = 0;
  std::string name;
  Key open{};  ///< Ed25519
  Address address;
  bool directed = false;   ///< the roster says whom it hears
  std::vector<int> hears;  ///< ids, where it does
};

struct Roster {
  std::string path;
  Schedule schedule;
  std::vector<double> initial;  ///< the estimate that all start with; empty = zero
  std::vector<Member> members;  ///< ascending ids

  const Member* find(int id) const;
  const Member* find(const std::string& name) const;
};

/// @throws IoError, InvalidInput
Roster read_roster(const std::string& path);
Roster parse_roster(const std::string& text, const std::string& path);

/// The schedule for an agent of so many rounds: what the roster leaves open is filled in, what cannot be met
/// is refused.
Schedule schedule_for(const Roster& roster, int rounds);

/// What both ends of a link must agree on: design, schedule and start. Nodes of another run cannot link up.
Prologue prologue_of(std::uint64_t design, const Schedule& schedule, std::span<const double> initial,
                     std::span<const double> inputs = {});

}  // namespace garrison::node
