// SPDX-License-Identifier: Apache-2.0
// The data-free table of a saturated consensus filter, as agents read it (theorem T, docs/certificates.md).
#pragma once

#include <algorithm>
#include <cstdint>

#include "garrison/core/error.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/filters/saturation/proved_sets.hpp"
#include "garrison/filters/saturation/recovery.hpp"

namespace garrison::saturation {

/// Bounds that hold whatever s attacked sensors do, for agents that test, are informed or are isolated, as
/// long as no message is missing behind the estimate. Infinite where there is none.
struct DataFree {
  static constexpr std::int64_t kForEver = INT64_MAX / 4;
  Matrix d;  ///< steps + 2 rows, a column per agent: ||e_i(t)|| <= d(t, i); the last row holds for ever after
  Matrix H;  ///< the same for honest innovations: |h_j(t)| <= H(t, j); row 0 is NaN
  std::int64_t until = kForEver;  ///< last sample that it says anything of
  Vector worst;                   ///< the largest of each row of d, over all agents
  ProvedSets proved;              ///< with the detector: once all attackers are
  LossTables losses;              ///< where it goes on after lost messages
  int only = -1;                  ///< of this agent alone, in column 0; -1 = of all

  bool empty() const { return d.size() == 0; }
  double bound(int agent, std::int64_t t) const { return t <= until ? d(row(t), column(agent)) : kInfinity; }
  double level(int agent, std::int64_t t) const { return t <= until ? H(row(t), column(agent)) : kInfinity; }
  /// Bound once all attackers are proved: `set` of `proved`, which the agent's list was first at the end of
  /// sample `full`.
  double bound_after(int agent, std::int64_t t, int set, std::int64_t full) const {
    const std::int64_t t0 = full + proved.spread;
    return proved.bound(set, column(agent), t - t0, worst(row(t0)));
  }
  /// What one agent needs of it.
  GARRISON_EXPORT DataFree of(int agent) const;

  /// Of a design file: it has what agent `agent` of `agents` reads, in samples of so many rounds.
  bool fits(int agent, int agents, int rounds) const noexcept {
    if (empty()) return losses.empty();
    const Eigen::Index columns = only < 0 ? agents : 1;
    return (only < 0 || only == agent) && d.cols() == columns && H.cols() == columns &&
           H.rows() == d.rows() && worst.size() == d.rows() && proved.fits(agents, columns) &&
           losses.fits(d.rows(), columns, rounds);
  }

  template <class V>
  void visit(V& v) {
    v("d", d);
    v("H", H);
    v.range("until", until, 0, kForEver);
    v("worst", worst);
    v("proved", proved);
    v("losses", losses);
    v.range("only", only, -1, INT32_MAX);
  }
  /// ||error|| of an estimate of sample t before round `round` that no lost message lies behind.
  double whole(std::int64_t t, int round) const noexcept { return losses.whole(row(t), round); }
  /// Of an agent, where a message was lost: on the error of its estimate of sample t.
  double recovered(int agent, std::int64_t t, const LossRecord& r) const noexcept {
    if (r.lost) return r.bound;
    return bound(agent, t) + losses.excess.error_excess(column(agent), r.state, t);
  }
  /// Levels of sample t, from what is known of the sample before, where the error was at most `before`.
  Levels levels_after(int agent, std::int64_t t, const LossRecord& r, double before,
                      double beta) const noexcept {
    return levels(losses, column(agent), r.state, before, t, level(agent, t), beta);
  }

 private:
  Eigen::Index row(std::int64_t t) const { return std::min(static_cast<Eigen::Index>(t), d.rows() - 1); }
  Eigen::Index column(int agent) const { return only < 0 ? agent : 0; }
};

/// What the table is made for, besides model and network.
struct DataFreeOptions {
  int attacked = 0;                 ///< s
  double initial_error = kNaN;      ///< bound on every initial error
  double beta = kNaN;               ///< saturation level; NaN = adaptive
  double alpha = 0.0;               ///< consensus step
  std::span<const double> omega{};  ///< Chebyshev weight per round; empty = plain
  int rounds = 0;
  bool detector = false;  ///< also for agents that know all attackers
  bool recovery = false;  ///< also for agents that messages were lost behind
  /// > 0: Gaussian noise (theorem TG) instead of bounded: with this probability at most anything that is said
  /// of samples 1..horizon is false, of any agent.
  double failure = 0.0;
  int horizon = 0;
};

/// The averaging of a whole sample, N x N: column j is what a unit at agent j becomes. `spread`: also the
/// largest row sum of the weights' sizes after k rounds, k = 0..rounds.
Matrix averaging(const Network& network, double alpha, std::span<const double> omega, int rounds,
                 Vector* spread = nullptr);

/// The table, until it is steady or for some thousand samples. Model: at most one output of length 1 per
/// agent, both noise bounds, or with `failure` both covariances. O((N n)^3) per sample of memory. @throws
/// InvalidInput for more than 400 numbers N n
GARRISON_EXPORT DataFree data_free(const Model& model, const Network& network,
                                   const DataFreeOptions& options);

}  // namespace garrison::saturation
