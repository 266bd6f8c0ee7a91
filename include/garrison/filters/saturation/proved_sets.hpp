// SPDX-License-Identifier: Apache-2.0
// What agents may say of their errors once all s attackers are proved, for every set that they may be
// (theorem I, docs/certificates.md).
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "garrison/core/agent_set.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::saturation {

/// ||e_i(t0 + k)|| <= fade(k, i) w + noise(k, i), k = 1..steps of the set, when ||e_l(t0)|| <= w for all l
/// and from t0 on all agents know that these are the attackers. Later errors: `bound`. Lossless steps.
struct ProvedSets {
  int s = 0;               ///< size of a set
  int spread = 0;          ///< samples from a full list of one agent to t0, when those of all are full
  std::vector<int> ids;    ///< of set k: ids[k s] .. ids[k s + s - 1], ascending
  std::vector<int> first;  ///< row of `fade` and `noise` where each set begins, and their number
  Matrix fade;             ///< a column per agent, or one alone
  Matrix noise;            ///< the same
  Matrix later;            ///< 3 x sets: largest fade, largest noise, largest fade of the last step

  int sets() const { return first.empty() ? 0 : static_cast<int>(first.size()) - 1; }
  /// Number of the set; -1 when it is none of them.
  int find(const AgentSet& proved) const noexcept {
    for (int k = 0; k < sets(); ++k) {
      const int* const set = ids.data() + static_cast<std::ptrdiff_t>(k) * s;
      if (std::all_of(set, set + s, [&](int id) { return proved.contains(id); })) return k;
    }
    return -1;
  }
  /// k samples after t0; infinite for k < 1, and for a set that is none. `column`: of the agent. worst = w.
  double bound(int set, Eigen::Index column, std::int64_t k, double worst) const noexcept {
    if (set < 0 || set >= sets() || k < 1) return kInfinity;
    const auto at = static_cast<std::size_t>(set);
    const int steps = first[at + 1] - first[at];
    const auto row = static_cast<Eigen::Index>(first[at] + std::min<std::int64_t>(k, steps) - 1);
    if (k <= steps) return fade(row, column) * worst + noise(row, column);
    // All errors from t0 on are at most `most`: those of the first steps by their rows, and each later one by
    // the last row and the error that many steps before.
    const double left = later(2, set);
    if (!(left < 1.0)) return kInfinity;
    const double most =
        std::max({worst, later(0, set) * worst + later(1, set), later(1, set) / (1.0 - left)});
    return fade(row, column) * most + noise(row, column);
  }
  /// What one agent needs of it.
  ProvedSets of(Eigen::Index column) const {
    ProvedSets part = *this;
    if (sets() > 0) {
      part.fade = fade.col(column);
      part.noise = noise.col(column);
    }
    return part;
  }

  /// Of a design file: nothing of it leads out of its own tables, for `columns` agents of `agents`.
  bool fits(int agents, Eigen::Index columns) const noexcept {
    if (sets() == 0) return true;
    const auto count = static_cast<std::size_t>(sets());
    const auto rows = [&](const Matrix& table) {
      return table.rows() == first.back() && table.cols() == columns;
    };
    return first.front() == 0 &&
           std::adjacent_find(first.begin(), first.end(), std::greater_equal<>()) == first.end() &&
           rows(fade) && rows(noise) && later.rows() == 3 && later.cols() == sets() && s >= 1 &&
           ids.size() / static_cast<std::size_t>(s) == count &&
           ids.size() % static_cast<std::size_t>(s) == 0 &&
           std::all_of(ids.begin(), ids.end(), [&](int id) { return id >= 0 && id < agents; });
  }

  template <class V>
  void visit(V& v) {
    v.range("s", s, 0, INT32_MAX);
    v.range("spread", spread, 0, INT32_MAX);
    v("ids", ids);
    v("first", first);
    v("fade", fade);
    v("noise", noise);
    v("later", later);
  }
};

/// For all sets of s of the agents with a sensor; empty where there are too many to work out. A, C, J: as
/// certificate::error_system. diameter: hops between the agents that are furthest apart; rounds >= 1.
GARRISON_EXPORT ProvedSets proved_sets(const MatrixRef& A, const MatrixRef& C, const MatrixRef& J, int s,
                                       int diameter, int rounds, double process_bound,
                                       const VectorRef& measurement_bound);

}  // namespace garrison::saturation
