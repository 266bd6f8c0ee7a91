// SPDX-License-Identifier: Apache-2.0
// What a saturation filter is made of: its gains, and the state and the messages of an agent.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "garrison/core/agent_set.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/filters/saturation/data_free.hpp"
#include "garrison/filters/saturation/setting.hpp"

namespace garrison::saturation {

/// What design leaves for the run: shared by all agents.
struct Gains {
  double alpha = 0.0;
  std::vector<double> omega;  ///< Chebyshev weight per round; empty = plain rounds
  int rounds = 0;
  bool bounded = false;  ///< setting and q0 below are valid
  bool detector = false;
  bool sharp_index = false;
  bool adaptive = false;
  bool accuse_missing = false;
  double varpi = kNaN;  ///< theorem 3; adaptive threshold only
  double q0 = kNaN;     ///< (8)
  double p0 = kNaN;     ///< (8)
  double beta = kInfinity;
  Setting setting;
  DataFree table;  ///< empty = not asked for

  template <class V>
  void visit(V& v) {
    v("alpha", alpha);
    v("omega", omega);
    v.range("rounds", rounds, 0, 1000000);
    v("bounded", bounded);
    v("detector", detector);
    v("sharp_index", sharp_index);
    v("adaptive", adaptive);
    v("accuse_missing", accuse_missing);
    v("varpi", varpi);
    v("q0", q0);
    v("p0", p0);
    v("beta", beta);
    v("setting", setting);
    v("table", table);
  }
};

/// Whom an agent accuses that holds a refuted assumption.
inline const AgentSet kNobody;

/// What an agent remembers besides its estimate.
struct Memory {
  double innovation = kNaN;  // the largest of this agent's outputs
  double level = kNaN;       // in force at t: phi_i of the detector, or the adaptive beta
  double rho = kNaN;         // rho or rhobar_i at t-1
  double p = kNaN;           // p at t-1
  int still = -1;            // with so many sensors proved rho and p stay as they are; not part of a snapshot
  double size = 0.0;         // largest number of the latest estimates, where there are bounds
  std::int64_t t = 0;        // sample of the estimate
  int d = 0;                 // |I_i(t-1)|
  std::int64_t full = -1;    // sample at whose end all attackers were proved here; -1 = not yet
  int which = -1;            // of Gains::table.proved
  bool started = false;      // rho and p have moved on from the start
  bool refuted = false;      // more are proved than can be attacked
  bool intact = true;        // no message is missing behind this estimate, and the start was covered
  Verdict verdict = Verdict::not_tested;
  AgentSet proved;                       // I_i
  std::unique_ptr<double[]> prediction;  // room for A xhat_i(t-1) where n is not known when compiling
  std::unique_ptr<double[]> previous;    // the estimate one round ago; Chebyshev only
  std::unique_ptr<LossRecord> loss;      // with `recovery`

  template <class V>
  void visit(V& v) {
    still = -1;
    v("innovation", innovation);
    v("level", level);
    v("rho", rho);
    v("p", p);
    v("size", size);
    v.range("t", t, 0, INT64_MAX / 4);
    v.range("d", d, 0, INT32_MAX);
    v.range("full", full, -1, INT64_MAX / 4);
    v.range("which", which, -1, INT32_MAX);
    v("started", started);
    v("refuted", refuted);
    v("intact", intact);
    v.choice("verdict", verdict, kVerdicts);
    v("proved", proved);
    if (loss != nullptr) v("recovery", *loss);
  }
};

template <int n>
struct State : Memory {
  Vec<n> x;  // xhat_i(t)

  template <class V>
  void visit(V& v) {
    v("estimate", x);
    Memory::visit(v);
  }
};

template <int n>
struct Message {
  Vec<n> x;
  bool intact = true;
  LossNote loss;  // with `recovery`, in place of `intact`
  AgentSet proved;

  template <class V>
  void visit(V& v) {
    v.numbers("estimate", x);
    if (loss.kept())
      loss.visit(v);
    else
      v.flag("intact", intact);
    v.set("proved", proved);
  }
};

}  // namespace garrison::saturation
