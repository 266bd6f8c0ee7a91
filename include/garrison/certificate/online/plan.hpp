// SPDX-License-Identifier: Apache-2.0
// The certificate of a run: what is asked for, and what design leaves of it for the agents.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "garrison/certificate/online/evidence.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"

namespace garrison::certificate {

/// Which measurements reach an agent.
enum class Spread : std::uint8_t {
  local,    ///< its own and its neighbours', and the best region that anybody found from such
  flooded,  ///< all that the rounds of a sample bring: messages carry every measurement known so far
  direct,   ///< its own and its neighbours', and nothing else that others say: bounds hold also where agents
            ///< lie in their messages, as long as liars and attacked sources are at most s together
};

/// What a run is asked to certify: with at most `attacked` sources lying (an agent with all its outputs is
/// one, unless the model names the sources), each reported bound fails with probability at most `failure`.
struct Wanted {
  Spread spread = Spread::local;
  /// Per agent and sample, for noise of the model's covariances; 0 = never, for noise within its bounds.
  double failure = 1e-6;
  int attacked = 0;    ///< s
  int subsets = 1000;  ///< W3 is used where at most so many sets of honest sources are to be tried, else W2
  /// Levels of W instead of those of the covariances, in standard deviations: those that clean records exceed
  /// at the rate `failure` (calibrated_levels), whatever their law. Both 0 = none.
  double z1 = 0.0;
  double z2 = 0.0;
  /// Beside W and R a bank (B) at every agent, over all that it hears: the attacked sources must be the same
  /// in all samples. Each half of `failure` is for one of them. Only with covariances, and failure > 0.
  bool memory = false;

  bool operator==(const Wanted&) const = default;
  template <class V>
  void visit(V& v) {
    v.choice("spread", spread, 3);
    v("failure", failure);
    v.range("attacked", attacked, 0, INT32_MAX);
    v.range("subsets", subsets, 0, 1000000);
    v("z1", z1);
    v("z2", z2);
    v("memory", memory);
  }
};

/// A measurement follows from an estimate x where C x is as near to it as this part of its deviation, or of
/// its bound (Plan::width has room for that).
inline constexpr double kFollows = 1e-10;

/// What becomes of an agent's measurements in its first message of a sample.
enum class Told : std::uint8_t {
  never_derived,  ///< they are in it, as numbers
  as_numbers,     ///< the same, where others would take silence for `derived`
  derived,        ///< they follow from its estimate, and nothing more is said of them
};

/// A bank takes at most so many filters, the sets of sources that may be attacked.
inline constexpr int kMostBankMembers = 3000;

inline constexpr int kUnknownReach = INT32_MAX;

/// What the banks need; empty without Wanted::memory.
struct BankPlan {
  Matrix Q{};
  /// Level of innovations in the samples 2^k .. 2^(k+1) - 1 since a bank started: all of them fail with a
  /// quarter of `failure`, however long it runs.
  std::vector<double> z1{};
  double z2 = kNaN, zc = kNaN;  ///< of the state; another quarter

  template <class V>
  void visit(V& v) {
    v("Q", Q);
    v("z1", z1);
    v("z2", z2);
    v("zc", zc);
  }
};

/// The rows of some agents, quantiles and how regions age. An agent holds those it can hear of.
///
/// Failure probability, Gaussian. F(t), in sample t: some measurement is beyond z1 (T1), or the least-squares
/// vector of the full set of rows beyond z2_full, or that of one of the partial sets that losses and locality
/// leave, one per agent, beyond z2_partial (T2). An agent uses its own region of this sample and one that was
/// relayed: the smallest of those that are at most kChoice samples older than the freshest to be had, whose
/// age losses alone decide. So it rests on kChoice + 2 events F, which share three quarters, and on kChoice +
/// 1 sums of process noise, which share the rest. With levels that are given, each F fails with `failure` for
/// an agent, and a bound with at most kChoice + 2 and a quarter of it.
struct GARRISON_EXPORT Plan {
  std::int32_t messages = 2;  ///< version of how they are written: agents of another do not understand them
  Wanted wanted;
  bool family = true;  ///< the bound of the filter's family holds for as many attacked sources, too
  int agents = 0;
  int sources = 0;           ///< of the whole network
  std::vector<int> ids;      ///< agents whose rows are here, ascending
  std::vector<int> first;    ///< rows of ids[k]: first[k] .. first[k+1]-1
  Matrix rows;               ///< n x rows: each C_r as a column
  Vector variance;           ///< of each row
  Vector width;              ///< |v| <= width; deterministic only
  std::vector<int> source;   ///< of each row
  int all_rows = 0;          ///< of the whole network, those that are not zero
  double z1 = kNaN;          ///< levels of W; not used when deterministic
  double z2_full = kNaN;     ///< for all rows of the network
  double z2_partial = kNaN;  ///< for any other set of rows
  Matrix A;
  /// Hops from any agent to any other at most, where all links are there; kUnknownReach = not known, or some
  /// are never reached.
  int reach = kUnknownReach;
  std::vector<double> norm;  ///< ||A^k||, for the ages k = 0..ages()
  BankPlan bank{};
  std::vector<double>
      added;  ///< what k steps of process noise add to a radius; empty = not known, nothing ages

  /// Part of `failure` that W and R together may use.
  double own_failure() const;
  bool deterministic() const { return wanted.failure == 0.0; }
  /// The rounds whose messages carry the region that is relayed are first_relay .. relay_end - 1. Not the
  /// first of all, if there are enough: the regions of the sample follow from what it brings.
  int first_relay(int rounds) const { return reach < rounds ? 1 : 0; }
  int relay_end(int rounds) const { return reach < rounds - kRepeats ? reach + kRepeats : rounds; }
  bool relays_in(int round, int rounds) const {
    return round >= first_relay(rounds) && round < relay_end(rounds);
  }
  int ages() const { return static_cast<int>(added.size()) - 1; }
  int states() const { return static_cast<int>(A.rows()); }
  /// Position of an agent in `ids`; -1 when its rows are not here.
  int place(int agent) const;
  int outputs(int agent) const;
  /// Whether measurements are not sent that follow from the estimate in an agent's first message. Flooded,
  /// they travel on as numbers; direct, an agent that lies in its estimates must not lie with them.
  bool derives() const { return wanted.spread == Spread::local; }
  bool derives(int agent) const { return derives() && outputs(agent) > 0; }
  /// What everybody uses for the measurement of this row, its own agent included: the same bits everywhere.
  double derived(std::size_t row, const double* x) const;
  /// What is told of y where x (null = none) is the estimate in the message; what is used for y to `out`.
  Told tell(int agent, const double* y, const double* x, double* out) const;
  /// By how much the noise of so many samples, in standard deviations, may be longer where it is derived.
  double derivation(double samples) const {
    return derives() ? kFollows * std::sqrt(samples * all_rows) : 0.0;
  }

  template <class V>
  void visit(V& v) {
    v.range("messages", messages, 2, 2);
    v("wanted", wanted);
    v("family", family);
    v.range("agents", agents, 1, INT32_MAX);
    v.range("sources", sources, 0, INT32_MAX);
    v("ids", ids);
    v("first", first);
    v("rows", rows);
    v("variance", variance);
    v("width", width);
    v("source", source);
    v("all_rows", all_rows);
    v("z1", z1);
    v("z2_full", z2_full);
    v("z2_partial", z2_partial);
    v("A", A);
    v.range("reach", reach, 0, kUnknownReach);
    v("norm", norm);
    v("added", added);
    v("bank", bank);
  }
};

/// @throws InvalidInput when the noise that `wanted` rests on is not known, or a number is out of range
GARRISON_EXPORT Plan make_plan(const Wanted& wanted, const Model& model, const Network& network);
/// What agent `id` needs of it.
Plan part_of(const Plan& plan, int id, std::span<const int> neighbours);
/// Whether a plan that was read can be worked with: sizes and indices fit together.
bool consistent(const Plan& plan);

}  // namespace garrison::certificate
