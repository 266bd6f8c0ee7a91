// SPDX-License-Identifier: Apache-2.0
// What k steps of the linear error system do, as numbers.
#pragma once

#include <vector>

#include "garrison/certificate/error_system.hpp"

namespace garrison::certificate {

/// Row i, column l, contiguous over l.
using Gains = Eigen::Matrix<double, Dynamic, Dynamic, Eigen::RowMajor>;

/// i, j, l: agents; k = 0..K-1, for Rb and Re also K; M^0 = I. All entries >= 0.
struct Kernels {
  ErrorSystem system;
  std::vector<Gains> gb;  ///< [k](i, l) = |block i of M^k B, column l|
  std::vector<Gains> ge;  ///< [k](j, l) = |C_j A (block j of M^k B, column l)|
  Gains wb;               ///< (k, i) = ||block i of M^k B_w||
  Gains we;               ///< (k, j) = |C_j A (block j of M^k B_w)|
  std::vector<Gains> Rb;  ///< [k](i, l) = ||(M^k)_il||
  std::vector<Gains> Re;  ///< [k](j, l) = |C_j A (M^k)_jl|

  int window() const { return static_cast<int>(gb.size()); }
};

/// `window` = K >= 1, best so large that the largest row sum of Rb[K] is below 1e-3. O(K (Nn)^3), done at
/// design time. @throws InvalidInput for K < 1 or more than 1e8 numbers
GARRISON_EXPORT Kernels kernels(const ErrorSystem& system, int window);

/// ||block|| (largest singular value), without overflow. Finite entries.
double spectral_norm(const MatrixRef& block);

}  // namespace garrison::certificate
