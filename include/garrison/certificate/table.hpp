// SPDX-License-Identifier: Apache-2.0
// Data-free table (T): error bounds that hold whatever s attacked sensors do, from design data alone. Needs
// every message of the steps behind an estimate.
#pragma once

#include <optional>

#include "garrison/certificate/kernels.hpp"

namespace garrison::certificate {

struct TableOptions {
  int s = 0;           ///< at most s sensors attacked at a time
  double start = 0.0;  ///< bound on every ||e_i(0)||
  int T = 1;           ///< last step, >= 1
  /// Fixed common level of the injections; none: the adaptive level H, which clips no honest sensor. Use the
  /// adaptive level only with the detector.
  std::optional<double> beta{};
  bool fixed = false;  ///< the attacked set never changes (S-fixed): smaller or equal
};

/// Constants that hold from the last step of a table on.
struct Steady {
  Vector d;    ///< N
  Vector eta;  ///< N
};

/// Row t = 0..T, column = agent. Infinite once the recursion overflows.
struct Table {
  Gains d;      ///< ||e_i(t)|| <= d_i(t)
  Gains eta;    ///< |C_j A e_j(t)| <= eta_j(t)
  Gains H;      ///< honest innovations: |h_j(t)| <= H_j(t), the detector's level; row 0 is NaN
  Gains level;  ///< H or beta; row 0 is NaN
  /// Absent when the bound diverges, or when it cannot be told yet (T < K + 2).
  std::optional<Steady> steady;
};

/// Theorem T. ||w|| <= bw, |v_j| <= bv_j. bw >= 0; bv: N numbers >= 0. O(T K N^2).
/// @throws InvalidInput for s < 0, start < 0, T < 1, beta < 0, noise out of range, more than 1e8 numbers
GARRISON_EXPORT Table table(const Kernels& kernels, const TableOptions& options, double bw,
                            const VectorRef& bv);

}  // namespace garrison::certificate
