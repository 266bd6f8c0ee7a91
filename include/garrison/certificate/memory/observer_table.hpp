// SPDX-License-Identifier: Apache-2.0
// Data-free bound of one observer with clipped innovations (O): the attacked set may move in every step.
#pragma once

#include <span>

#include "garrison/certificate/kernels.hpp"

namespace garrison::certificate {

/// Row t = 0..T. Infinite from where the recursion overflows or exceeds 1e12.
struct ObserverTable {
  Gains d;      ///< columns: |e_i(t)| per coordinate, and ||e(t)|| (last)
  Gains eta;    ///< column r: |C_r A e(t)|
  Gains level;  ///< column r: bound of an honest innovation, where it is clipped; row 0 is 0
};

struct ObserverOptions {
  int s = 0;           ///< at most s sources attacked in each step
  double bw = 0.0;     ///< ||w~|| <= bw
  double start = 0.0;  ///< ||e(0)|| <= start
  int T = 1;           ///< last step, >= 1
  int lags = 1;        ///< lags that are unrolled, >= 1
};

/// xhat = A xhat + sum_r L_r kappa_r, every innovation clipped to its level. A: n x n; C: m x n; L: n x m (a
/// Kalman gain, or any); Gam: n x q, w = Gam w~; bv: |v_r| <= bv_r; source: of each row, 0.., or empty: its
/// position. O(T lags m n). @throws InvalidInput
GARRISON_EXPORT ObserverTable observer_table(const MatrixRef& A, const MatrixRef& C, const MatrixRef& L,
                                             const MatrixRef& Gam, const VectorRef& bv,
                                             std::span<const int> source, const ObserverOptions& options);

}  // namespace garrison::certificate
