// SPDX-License-Identifier: Apache-2.0
// The windowed recursion that both tables share. Internal.
#pragma once

#include <functional>
#include <vector>

#include "garrison/certificate/table.hpp"

namespace garrison::certificate::detail {

/// What the inputs of one step may be, per sensor: theta, the extra of an attacked one; psi, what clipping
/// takes from an honest one.
struct Inputs {
  Vector H, level, theta, psi;
};

class Recursion {
 public:
  /// `noise_d`, `noise_eta`: row m: contribution of bounded noise over m lags (zero in the Gaussian case).
  Recursion(const Kernels& kernels, const TableOptions& options, Gains noise_d, Gains noise_eta);

  /// Of one step: H0 bounds an honest innovation less the sensor's own noise, which is at most b.
  Inputs inputs(const Vector& H0, const Vector& b) const;

  /// d and eta of a step: `m` lags, `at(k)` the inputs k steps ago, `before` = d(t - m).
  void step(int m, const std::function<const Inputs&(int)>& at, const Vector& before, Vector& d, Vector& eta);

  /// Fills the table; `next(t, eta(t-1))` gives the inputs of step t.
  Table run(const std::function<Inputs(int, const Vector&)>& next);

  /// (1 + 1e-3) x the maxima over the last K + 1 steps, accepted when one application of the recursion gives
  /// nothing larger: it is monotone, so they are then invariant. No tolerance: a slowly growing table must be
  /// refused. `next(eta)`: the inputs for ever.
  std::optional<Steady> steady(const Table& table, const std::function<Inputs(const Vector&)>& next);

 private:
  double attacked(const std::vector<Gains>& g, Eigen::Index i, int m,
                  const std::function<const Inputs&(int)>& at);

  const Kernels& k_;
  const TableOptions& o_;
  Gains noise_d_, noise_eta_;
  std::vector<double> room_;
};

/// What table() and gaussian_table() refuse. @throws InvalidInput
void require_table(const Kernels& kernels, const TableOptions& options);

}  // namespace garrison::certificate::detail
