// SPDX-License-Identifier: Apache-2.0
// What a node says of itself: from the loop as bytes through the ring, to people as JSON.
#pragma once

#include <string>
#include <vector>

#include "garrison/node/node.hpp"
#include "node/daemon/sensor.hpp"

namespace garrison::node {

/// Numbers only, so that it travels as it lies in memory.
struct StatusHead {
  Micros wall = 0;
  bool ended = false;  ///< a sample ended, which `sample` is of; else a sign of life
  Sample sample;
  Core::State state = Core::State::idle;
  Core::Counters counters;
  Fates outside;
  std::int64_t unsent = 0;
  std::int64_t log_gaps = 0;
  std::int64_t statements = 0;
  std::int64_t contradictions = 0;
  std::int64_t disowned = 0;
  std::int64_t resets = 0;
  double control = kNaN;
};
struct LinkStatus {
  LinkView view;
  Fates fates;
};

struct Status {
  StatusHead head;
  std::vector<double> estimate;
  std::vector<LinkStatus> links;

  /// False when the bytes are no status of so many states and links.
  bool read(Bytes bytes, std::size_t states, std::size_t links);
};

/// What only the other thread knows.
struct Surroundings {
  std::string node;
  int id = 0;
  std::string family;
  std::vector<std::string> names;  ///< of the links, as in the status
  std::vector<double> input;       ///< known, that led to the sample; empty = none
  std::vector<int> accused;
  std::vector<int> proved;  ///< sources, Agent::proved
  Sensor::Counters sensor;
  Micros snapshot_age = -1;
  std::int64_t log_failed = 0;      ///< writes
  std::int64_t states_refused = 0;  ///< that an earlier life left
  std::uint64_t boot = 0;
};

/// A line of JSON without its end: the sample alone, or everything.
std::string sample_json(const Status& status, const Surroundings& around);
std::string status_json(const Status& status, const Surroundings& around);

}  // namespace garrison::node
