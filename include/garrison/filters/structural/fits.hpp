// SPDX-License-Identifier: Apache-2.0
// Whether gains that were read from a design file are those of an agent: nothing that it reads leads out of
// them.
#pragma once

#include <cstddef>
#include <span>

#include "garrison/filters/structural/parts.hpp"

namespace garrison::structural {

/// `one` of an agent: itself first, then its neighbours, each with a column of n numbers or none.
inline bool hears(const Gains& g, const Local& l, std::span<const int> neighbours) noexcept {
  const auto id = static_cast<std::size_t>(l.id);
  const int begin = g.offsets[id];
  const int end = g.offsets[id + 1];
  if (begin < 0 || static_cast<std::size_t>(end - begin) != neighbours.size() + 1 ||
      static_cast<std::size_t>(end) > g.heard.size())
    return false;
  for (int k = begin; k < end; ++k) {
    const Heard& one = g.heard[static_cast<std::size_t>(k)];
    const bool own = k == begin;
    if (one.id != (own ? l.id : neighbours[static_cast<std::size_t>(k - begin - 1)])) return false;
    if (one.first < 0
            ? own && l.outputs > 0
            : static_cast<std::size_t>(one.first) + static_cast<std::size_t>(l.states) > g.columns.size())
      return false;
  }
  return true;
}

/// l: without matrices.
inline bool fits(const Gains& g, const Local& l, std::span<const int> neighbours) noexcept {
  const auto agents = static_cast<std::size_t>(l.agents);
  const auto n = static_cast<std::size_t>(l.states);
  const auto window = static_cast<std::size_t>(g.window);
  const bool tables = l.outputs <= 1 && g.offsets.size() == agents + 1 && g.rows.size() == agents * n &&
                      g.std.size() == agents && g.innovation_std.size() == agents &&
                      g.has_sensor.size() == agents;
  if (!tables || g.offsets[static_cast<std::size_t>(l.id)] > g.offsets[static_cast<std::size_t>(l.id) + 1])
    return false;
  if (window > 1 && !g.precision.empty() && g.precision.size() != agents * window * window) return false;
  const bool carried = g.covariance.size() == n * n || g.covariance.size() == agents * n * n;
  if (!g.covariance.empty() && !(carried && g.process.size() == n * n && g.noise.size() == agents))
    return false;
  if (g.isolate && !g.covariance.empty() && (g.doubt.size() != agents || g.haste.size() != agents))
    return false;
  if (g.innovation && g.noise.size() != agents && !g.covariance.empty()) return false;
  return hears(g, l, neighbours);
}

}  // namespace garrison::structural
