// SPDX-License-Identifier: Apache-2.0
// Data-free table for Gaussian noise (TG): d and eta hold the start, the attack and the clipping; the noise
// part is exactly Gaussian and added by its quantile.
#pragma once

#include "garrison/certificate/table.hpp"

namespace garrison::certificate {

struct GaussianTable {
  /// Its `steady` is tested with the limit of the covariance, so that it holds for ever as far as the event
  /// does.
  Table table;
  Gains deviation;  ///< sqrt(lmax(P_ii(t))), row t = 0..T, column = agent
  /// What `deviation`, and the deviation of honest innovations' noise, never exceed, N numbers; empty where M
  /// is not Schur.
  Vector deviation_for_ever{}, innovation_for_ever{};

  /// Bounds of all agents at t: ||e_i(t)|| <= d_i(t) + chi_n(delta) deviation_i(t), failing with probability
  /// <= N T Q(z) + delta for each (i, t). @throws InvalidInput for t outside 0..T, delta outside (0, 1)
  GARRISON_EXPORT Vector bound(int t, double delta) const;
  int states = 1;
};

/// Theorem TG. w ~ N(0, Q), v_j ~ N(0, R_j), independent, white. `z`: level of the event that no noise part
/// of an honest innovation exceeds z of its deviations, which fails with probability <= N T Q(z) over the
/// whole table. Q: n x n, symmetric, positive semidefinite; R: N variances >= 0; z >= 0. @throws InvalidInput
GARRISON_EXPORT GaussianTable gaussian_table(const Kernels& kernels, const TableOptions& options,
                                             const MatrixRef& Q, const VectorRef& R, double z);

}  // namespace garrison::certificate
