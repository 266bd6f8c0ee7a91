// SPDX-License-Identifier: Apache-2.0
// Steady-state covariances of the distributed Kalman filter.
#pragma once

#include "garrison/filters/rdkf/setting.hpp"

namespace garrison::rdkf {

/// One application of (5), for all agents at once:
///   P_i <- ((1/d_i) sum over j in N_i of (A P_j A' + Sw_j)^-1 + C_i' Sv_i^-1 C_i)^-1.
/// The appendix' reading; the printed (5) lacks the inverse of the bracket and inverts Sw, which biases (7)
/// (docs/filters/rdkf.md#r1). P: one n x n matrix per agent, symmetric positive semidefinite.
GARRISON_EXPORT std::vector<Matrix> riccati_sweep(const Setting& s, const std::vector<Matrix>& P);

/// Of a part of a network: agents of other parts, whose equations are not known here, and what is asked of
/// all parts. All parts make the same calls.
/// Threads: one at a time.
class Borders {
 public:
  virtual ~Borders() = default;
  /// Gives the agents of other parts the P_i that those have.
  virtual void refresh(std::vector<Matrix>& P) = 0;
  /// Largest of all parts; no NaN.
  virtual double largest(double value) = 0;
};

struct SteadyOptions {
  std::vector<Matrix>
      start;  ///< warm start, one P_i per agent; empty = from zero. The limit does not depend on it
  double tolerance = 1e-14;  ///< largest relative change of an entry in the last sweep
  int most_sweeps = 20000;   ///< when neither 400 sweeps nor Newton's method settle
  /// Null: the setting is a whole network. A part has the sweeps alone, with the bits of the whole.
  Borders* borders = nullptr;
};

/// Solution of (5), and how it was reached.
struct SteadyState {
  std::vector<Matrix> P;     ///< (5)
  std::vector<Matrix> Pbar;  ///< (6): A P_j A' + Sw_j
  std::vector<Matrix> Q;     ///< (1/d_i) sum over N_i of Pbar_j^-1
  int sweeps = 0;  ///< of (5); steps of Newton's method, where the sweeps are slow, count as one each
  double change =
      0.0;  ///< relative change in the last sweep: at most the tolerance, or where rounding stops it
};

/// Where 400 sweeps do not settle (Sw/Sv below about 1e-3, integrators at a small period), Newton's method
/// does, from the solution for more process noise; for Sw/Sv down to about 1e-14, below which rounding
/// decides.
/// @throws InvalidInput when a start has a wrong shape, when P grows beyond 1e14 times the noise (a mode that
/// is hardly seen), or when nothing settles
GARRISON_EXPORT SteadyState steady_state(const Setting& s, const SteadyOptions& options = {});

}  // namespace garrison::rdkf
