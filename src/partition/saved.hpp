// SPDX-License-Identifier: Apache-2.0
// The state of an agent in a checkpoint, which any number of ranks go on from: nothing in it depends on what
// a rank calls its agents.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/filters/structural/filter.hpp"
#include "garrison/wire/archive.hpp"

namespace garrison::partition {

/// The set in a state that calls agents as this rank does; null where there is none.
template <class State>
AgentSet* set_of_names(State&) {
  return nullptr;
}
template <int n>
AgentSet* set_of_names(structural::State<n>& s) {
  return &s.accused;
}

/// An agent that a state may speak of.
struct Known {
  int name;
  int id;  ///< public
};

/// Appends a state; `known`: the agent itself and those that it hears.
template <class State>
void save_state(State& state, std::span<const Known> known, std::vector<std::byte>& out) {
  AgentSet* const set = set_of_names(state);
  AgentSet names;
  if (set != nullptr) std::swap(names, *set);
  wire::Writer writer(out);
  writer("state", state);
  if (set == nullptr) return;
  std::swap(names, *set);
  for (const Known& one : known) {
    if (!set->contains(one.name)) continue;
    out.resize(out.size() + 4);
    wire::store(out.data() + out.size() - 4, static_cast<std::uint32_t>(one.id));
  }
}

/// Reads it back into a state after `init`; false where it is none. `agents`: how many names there are.
template <class State>
bool load_state(std::span<const std::byte> bytes, std::span<const Known> known, int agents, State& state) {
  AgentSet* const set = set_of_names(state);
  if (set != nullptr) set->resize(0);
  wire::Reader reader(bytes, agents, false);
  reader("state", state);
  if (set == nullptr) return reader.end() == Refusal::none;
  set->resize(agents);
  auto rest = reader.rest();
  if (reader.refusal() != Refusal::none || rest.size() % 4 != 0) return false;
  for (; !rest.empty(); rest = rest.subspan(4)) {
    const auto id = static_cast<int>(wire::load<std::uint32_t>(rest.data()));
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const Known& one) { return one.id == id; });
    if (found == known.end()) return false;
    set->insert(found->name);
  }
  return true;
}

}  // namespace garrison::partition
