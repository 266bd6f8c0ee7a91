// SPDX-License-Identifier: Apache-2.0
// Whether gains that were read from a design file are those of an agent: nothing that it reads leads out of
// them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>

#include "garrison/core/filter.hpp"
#include "garrison/filters/rdkf/agent_step.hpp"

namespace garrison::rdkf {

inline bool fits(const Packed& m, int rows, int columns) noexcept {
  return m.rows == rows && m.columns == columns && m.height == padded(rows) &&
         m.values.size() == static_cast<std::size_t>(m.height) * static_cast<std::size_t>(columns);
}
inline bool fits(const Matrix& m, int rows, int columns) noexcept {
  return m.rows() == rows && m.cols() == columns;
}
/// The step of a sensor with q outputs.
inline bool fits(const StepFactors& f, int q, int n) noexcept {
  return fits(f.R, q, q) && fits(f.K, q, n) && fits(f.W, n, q) &&
         f.d.size() == static_cast<std::size_t>(padded(q));
}
inline bool fits(const BoxFactors& f, int q, int n) noexcept {
  return q <= kMostBoxOutputs && fits(f.R, q, q) && fits(f.M, q, n) && fits(f.W, n, q) && fits(f.H, q, q);
}
/// Of a sensor with several outputs its rows are kept, and the factor of Q beside them.
inline bool fits(const SensorRows& s, const Matrix& L, int q, int n) noexcept {
  return q <= 1 ? fits(s.C, 0, 0) && fits(s.S, 0, 0) : fits(s.S, q, q) && fits(s.C, q, n) && fits(L, n, n);
}

/// `heard` are the agent and its neighbours, and of each of them J is there.
inline bool hears(const Gains& g, const AgentGains& a, const Local& l,
                  std::span<const int> neighbours) noexcept {
  if (a.heard.size() != neighbours.size() + 1 ||
      std::adjacent_find(a.heard.begin(), a.heard.end(), std::greater_equal<>()) != a.heard.end())
    return false;
  return std::all_of(a.heard.begin(), a.heard.end(), [&](int j) {
    return (j == l.id || std::find(neighbours.begin(), neighbours.end(), j) != neighbours.end()) &&
           fits(g.agents[static_cast<std::size_t>(j)].J, l.states, l.states);
  });
}

/// What the penalty asks for, and nothing of what others do: room is made for the largest step.
inline bool steps_fit(const Gains& g, const AgentGains& a, const Local& l) noexcept {
  const int n = l.states;
  const int q = l.outputs;
  const bool group = g.penalty == Penalty::group;
  const bool box = g.penalty == Penalty::l1;
  const std::size_t blocks = group ? a.heard.size() : 0;
  if (a.blocks.size() != blocks || a.sensors.size() != std::max<std::size_t>(1, blocks)) return false;
  if (g.ipopt ? group || box || !fits(a.Q, n, n) : !fits(a.Q, 0, 0)) return false;
  if (box ? !fits(a.box, q, n) : !fits(a.box, 0, 0)) return false;
  if (group || box ? !fits(a.step, 0, 0) : !fits(a.step, q, n)) return false;
  if (!group) return fits(a.sensors[0], a.L, q, n);
  for (std::size_t k = 0; k < blocks; ++k) {
    const int rows = a.blocks[k].outputs();
    if (rows > std::min(g.most_outputs, kMostGroupOutputs) || (a.heard[k] == l.id && rows != q) ||
        !fits(a.blocks[k], rows, n) || !fits(a.sensors[k], a.L, rows, n))
      return false;
  }
  return true;
}

/// l: without matrices.
inline bool fits(const Gains& g, const Local& l, std::span<const int> neighbours) noexcept {
  if (g.agents.size() != static_cast<std::size_t>(l.agents) || g.most_outputs < l.outputs) return false;
  const AgentGains& a = g.agents[static_cast<std::size_t>(l.id)];
  return hears(g, a, l, neighbours) && fits(a.F, l.states, l.states) && steps_fit(g, a, l) &&
         (!g.bounded || a.reach.size() == a.heard.size());
}

}  // namespace garrison::rdkf
