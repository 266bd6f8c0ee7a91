// SPDX-License-Identifier: Apache-2.0
// Structural observability of a system by its sensors, and what each agent contributes to it.
#pragma once

#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "garrison/analysis/structure/components.hpp"
#include "garrison/analysis/structure/dulmage_mendelsohn.hpp"

namespace garrison::structure {

/// States that each agent's measurement depends on (the pattern of c_i); none for a relay.
using Sensors = std::vector<std::vector<int>>;

/// Section II-B of the structural paper: alpha agents measure a state of a contraction, beta agents one of a
/// parent component, gamma agents neither. By membership, alpha before beta before gamma
/// (docs/filters/structural.md#d4).
enum class AgentClass : char { alpha, beta, gamma };
GARRISON_EXPORT std::string_view name_of(AgentClass c);

/// Structural observability: for almost all numbers with this pattern the system is observable.
struct GARRISON_EXPORT Observability {
  bool output_connected = false;  ///< every state has a path to a measured one
  bool rank_condition = false;    ///< [A; C] has a matching of all n columns
  bool holds() const { return output_connected && rank_condition; }
};

/// The structure of a system matrix, worked out once. States are numbered from 0; entry (i, j) of A is the
/// link j -> i. All functions that take sensors refuse states out of range.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT System {
 public:
  /// @throws InvalidInput when the pattern is not square or has no state.
  explicit System(Pattern A);

  int states() const { return A_.columns(); }
  const Pattern& pattern() const { return A_; }
  const Decomposition& parts() const { return parts_; }
  const Components& components() const { return components_; }
  bool in_contraction(int state) const { return in_union_[static_cast<std::size_t>(state)] != 0; }
  bool in_parent(int state) const {
    return parent_[static_cast<std::size_t>(components_.of[static_cast<std::size_t>(state)])] != 0;
  }
  /// States of all contractions, sorted; does not depend on the matching.
  std::vector<int> contraction_union() const;
  /// Sorted lists of the components that no link leaves.
  std::vector<std::vector<int>> parent_components() const;

  Observability observability(const Sensors& sensors) const;
  std::vector<AgentClass> classes(const Sensors& sensors) const;
  /// Per agent: the system is structurally observable, but not without this agent alone. (The paper calls
  /// every alpha and beta agent necessary; a second one for the same class is not.) One search for all.
  std::vector<char> necessary(const Sensors& sensors) const;
  /// Per agent: every state that it could measure instead, so that the system is structurally observable;
  /// sorted, without its own where it measures a single one. One search per agent.
  std::vector<std::vector<int>> substitutes(const Sensors& sensors) const;
  /// Measured state u -> the least set Z that contains u, otherwise only states that no alpha agent measures,
  /// and has one row less than columns: the contraction of u, sorted. Exists when the rank condition holds
  /// and there are exactly as many alpha agents (measuring one state each) as the rank lacks; else empty.
  std::map<int, std::vector<int>> contraction_of_measured(const Sensors& sensors) const;
  /// States of the same class as `agent`'s (Algorithm 1): alpha: the contraction of its state, the states
  /// that others measure being matched after all unmeasured ones and its own last; beta: its parent
  /// component; without the state itself. gamma, or no or several states: none. `measured`: -1 = no sensor.
  std::vector<int> class_candidates(std::span<const int> measured, std::size_t agent, AgentClass as) const;

 private:
  void require(const Sensors& sensors) const;
  /// How many parent components no agent (other than `without`) measures, and one of them.
  std::vector<int> seen_parents(const Sensors& sensors) const;

  Pattern A_;
  Components components_;
  std::vector<char> parent_;
  int parent_count_ = 0;
  Decomposition parts_;
  std::vector<char> in_union_;
};

/// Structural observability of the distributed estimator: pattern (W kron A, D_C), where block i of D_C is
/// the union of the patterns of c_j c_j' over the agents j that i receives measurements from (section III).
/// W, U: N x N patterns of mixing weights and measurement links.
GARRISON_EXPORT Observability distributed_observability(const Pattern& A, const Sensors& sensors,
                                                        const MatrixRef& W, const MatrixRef& U);

}  // namespace garrison::structure
