// SPDX-License-Identifier: Apache-2.0
// One agent's step of (8), everything that does not depend on the other agents prepared.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "garrison/filters/rdkf/box_step.hpp"
#include "garrison/filters/rdkf/partial_step.hpp"
#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf {

/// Names of the numbers in a message that say which outputs are there, 16 to a number.
inline constexpr std::array<std::string_view, 8> kPresent = {"present",    "present_16", "present_32",
                                                             "present_48", "present_64", "present_80",
                                                             "present_96", "present_112"};
/// How many of them `outputs` outputs need.
inline std::size_t words(int outputs) { return (static_cast<std::size_t>(outputs) + 15) / 16; }
inline constexpr int kMostGroupOutputs = 16 * static_cast<int>(kPresent.size());

/// What design leaves for one agent.
struct AgentGains {
  std::vector<int> heard;  ///< N_i, itself included, sorted
  Packed J;                ///< Pbar_i^-1 A: its information vector is J xhat_i
  Packed F;  ///< (sum over N_i of Pbar_j^-1)^-1: the fused prediction x0 is F times the sum of vectors
  StepFactors step;  ///< penalties norm and huber
  BoxFactors box;    ///< penalty l1
  std::vector<StepFactors>
      blocks;  ///< penalty group: sensors of each agent in `heard` against this agent's Q
  Matrix Q;    ///< solver ipopt only
  Matrix L;    ///< lower Cholesky factor of Q, where a sensor may miss some of its outputs
  /// Sensors whose rows may be missing one by one: those of `blocks`, else this agent's own.
  std::vector<SensorRows> sensors;
  double deviation_bound = 0.0;  ///< half of (10): |xhat - x0| is at most this, whatever was measured
  double quiet_level = 0.0;      ///< a whitened residual of the prediction below this does not saturate
  std::vector<double> reach;     ///< run-time bound: what of the error of each agent in `heard` comes in
  double rounding = 0.0;         ///< run-time bound: rounding of x0 per unit of the information vectors

  template <class V>
  void visit(V& v) {
    v("heard", heard);
    v("J", J);
    v("F", F);
    v("step", step);
    v("box", box);
    v("blocks", blocks);
    v("Q", Q);
    v("L", L);
    v("sensors", sensors);
    v("deviation_bound", deviation_bound);
    v("quiet_level", quiet_level);
    v("reach", reach);
    v("rounding", rounding);
  }
};

/// What design leaves for the run.
struct Gains {
  std::vector<AgentGains> agents;
  Penalty penalty = Penalty::norm;
  Price price;
  bool ipopt = false;
  bool bounded = false;  ///< initial_error was given: certified bounds on the error at run time
  double initial_error = kNaN;
  double process_bound = 0.0;
  int most_outputs = 0;  ///< largest q_i, for messages that carry measurements

  template <class V>
  void visit(V& v) {
    v("agents", agents);
    v.choice("penalty", penalty, 4);
    v("price", price);
    v("ipopt", ipopt);
    v("bounded", bounded);
    v("initial_error", initial_error);
    v("process_bound", process_bound);
    v.range("most_outputs", most_outputs, 0, 65535);
  }
};

/// Whether the solver that the gains ask for is here.
GARRISON_EXPORT bool runs(const Gains& gains) noexcept;

/// Room and results of one agent's steps; sized once.
struct GARRISON_EXPORT Workspace {
  Aligned<double> memory;
  double* sum = nullptr;      ///< n, filled up: sum of the information vectors of N_i
  double* x = nullptr;        ///< n, filled up: x0, then the estimate
  double* product = nullptr;  ///< n, filled up
  double* room = nullptr;     ///< of the step
  double* y = nullptr;  ///< penalty group: a row of most_outputs per agent in `heard`; else own measurement
  std::vector<char> present;         ///< as y: whether the number is there
  std::vector<int> rows;             ///< per row of y: how many are there
  std::vector<PartialStep> partial;  ///< per row of y: its step where only some are
  double deviation = 0.0;            ///< |xhat - x0|
  Step step;

  void resize(const Gains& g, const AgentGains& a, int states);
};

/// out = M x; out has M.height entries.
GARRISON_EXPORT void multiply(const Packed& M, const double* x, double* out) noexcept;

/// w.sum and, if `measured`, w.y to w.x, w.step and w.deviation. Without a measurement the estimate is x0.
GARRISON_EXPORT void advance(const Gains& g, const AgentGains& a, bool measured, Workspace& w) noexcept;

}  // namespace garrison::rdkf
