// SPDX-License-Identifier: Apache-2.0
// A state between two rounds, as ranks send it that work out each other's rounds: what `visit` lists, which
// is enough between samples, and what means something within one only.
#pragma once

#include <cstddef>
#include <span>

#include "garrison/filters/saturation/parts.hpp"
#include "garrison/wire/archive.hpp"

namespace garrison::partition {

/// What a state has from one round to the next and its `visit` leaves out.
template <class V, class State>
void visit_within_sample(V&, State&) {}
/// Chebyshev rounds need what was one round before.
template <class V, int n>
void visit_within_sample(V& v, saturation::State<n>& s) {
  if (s.previous != nullptr) {
    std::span<double> previous(s.previous.get(), static_cast<std::size_t>(s.x.size()));
    v("previous", previous);
  }
  if (s.loss != nullptr) v("before", s.loss->before);
}

/// Bytes of a state; those of all agents of a family have one size after `init`.
template <class State>
std::size_t between_rounds_bytes(State& state) {
  wire::Writer counts(std::span<std::byte>{});
  counts("state", state);
  visit_within_sample(counts, state);
  return counts.used();
}
/// `out` has at least so many.
template <class State>
void write_between_rounds(State& state, std::span<std::byte> out) {
  wire::Writer writer(out);
  writer("state", state);
  visit_within_sample(writer, state);
}
/// Into a state after `init`, of any agent.
template <class State>
void read_between_rounds(std::span<const std::byte> in, int agents, State& state) {
  wire::Reader reader(in, agents, false);
  reader("state", state);
  visit_within_sample(reader, state);
}

}  // namespace garrison::partition
