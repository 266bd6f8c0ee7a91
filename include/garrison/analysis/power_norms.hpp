// SPDX-License-Identifier: Apache-2.0
// How much an error grows while nothing is measured: ||A^k||, not ||A||^k.
#pragma once

#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// Norms ||A^k|| (spectral) for k = 0, 1, ... and their sums. A chain of integrators with a short step has
/// ||A|| > 1 and ||A||^k without bound, while ||A^k|| grows like a polynomial: after 60 s without measurement
/// 1200 m, not 4e13.
/// Threads: constant once made; any number may share it.
class PowerNorms {
 public:
  /// Table of `most` >= 1 powers of A (n x n, finite); beyond it ||A^(k + j)|| <= ||A^k|| ||A^j|| is used, so
  /// that every number stays an upper bound. @throws InvalidInput
  PowerNorms(const MatrixRef& A, int most);

  /// Upper bound of ||A^k||, k >= 0; exact within the table.
  double norm(long long k) const;
  /// Upper bound of the error after k steps of pure prediction: ||A^k|| start + step (||A^0|| + ... +
  /// ||A^(k-1)||) for an initial error of at most `start` and process noise of at most `step` per step.
  double predicted(long long k, double start, double step) const;

 private:
  std::vector<double> norm_;  // ||A^k||, k = 0..most
  std::vector<double> sum_;   // of those before k
};

}  // namespace garrison
