// SPDX-License-Identifier: Apache-2.0
// Who takes over when a sensor is given up: Algorithm 1 of the structural paper and its cost-optimal forms.
#pragma once

#include <span>
#include <vector>

#include "garrison/analysis/structure/system.hpp"

namespace garrison::structure {

/// One line of the log; -1 = no sensor.
struct GARRISON_EXPORT Substitution {
  int agent;
  AgentClass type;
  int before, after;
};
struct GARRISON_EXPORT Mitigation {
  std::vector<int> measured;  ///< state that each agent measures now; -1 = none
  std::vector<Substitution> log;
};

/// How a substitute is chosen among the states that nobody measures or has given up in this run.
enum class Choice : char {
  by_class,  ///< Algorithm 1 as printed: lowest state of the class; a gamma agent's sensor goes unreplaced
  exact,     ///< any state that keeps the system structurally observable, the cheapest one; a sensor that is
             ///< not necessary goes unreplaced
};

/// The alarmed agents' sensors are replaced one at a time, in the given order, and classes are worked out
/// anew after each one (docs/filters/structural.md#d3: two substitutions at once can fail). `measured`: -1 =
/// no sensor. `cost`: agents x states for Choice::exact, or empty: all alike.
/// @throws InvalidInput when an agent or state does not exist.
GARRISON_EXPORT Mitigation mitigate(const System& system, std::span<const int> measured,
                                    std::span<const AgentClass> types, std::span<const int> alarms,
                                    Choice choice, const MatrixRef& cost);

/// Least-cost assignment of every row to a column of its own, infinite entries being forbidden: the column of
/// each row. rows <= columns. Empty when there is none. Successive shortest paths, O(rows^2 columns).
std::vector<int> cheapest_assignment(const MatrixRef& cost);

struct GARRISON_EXPORT Pick {
  int agent, state, group;  ///< group: index of the class covered, -1 where there are none
};
struct GARRISON_EXPORT Picks {
  bool exists = false;
  double cost = kInfinity;
  std::vector<Pick> picks;  ///< sorted by agent
};
/// Remark 9: one agent per class, each measuring its cheapest state of it. It can fail to restore
/// observability when classes overlap (docs/filters/structural.md#d29). `cost`: agents x states, not
/// negative.
GARRISON_EXPORT Picks cheapest_per_class(const MatrixRef& cost, std::span<const std::vector<int>> classes);
/// The cheapest sensors (agent, state), at most one state per agent, with which [A; sensors] has full
/// structural rank: one assignment of states to rows of A (cost 0) and agents.
GARRISON_EXPORT Picks cheapest_rank_sensors(const Pattern& A, const MatrixRef& cost);

}  // namespace garrison::structure
