// SPDX-License-Identifier: Apache-2.0
// What the analysis of the structural filter needs to know: model, two graphs, noise.
#pragma once

#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::structural {

/// x(k+1) = A x(k) + nu, y_i(k) = c_i'x(k) + zeta_i, N agents with one scalar measurement each (a relay has
/// c_i = 0). The letters are the paper's.
struct GARRISON_EXPORT Setting {
  Matrix A;  ///< n x n
  Matrix C;  ///< N x n, row i = c_i'
  Matrix W;  ///< N x N, mixing weights of the estimates (graph G_beta), >= 0, rows sum to 1
  Matrix U;  ///< N x N of 0 and 1: U(i, j) = 1 when i receives y_j (graph G_alpha); U(i, i) = 1
  Matrix E;  ///< n x n, covariance of nu
  Matrix R;  ///< N x N, covariance of zeta; agents' noises may be correlated

  Eigen::Index n() const { return A.rows(); }
  Eigen::Index N() const { return C.rows(); }
};

/// K_i of (4), n x n, one per agent. Only its action on span{c_j : U(i, j) = 1} has an effect.
using GainMatrices = std::vector<Matrix>;

/// @throws InvalidInput naming the first item that does not fit: shapes, numbers that are not finite, W with
/// a negative entry or a row sum other than 1 (1e-9), U with other entries than 0 and 1 or without its
/// diagonal.
GARRISON_EXPORT void require_graphs(const Setting& s);
/// The same, and E and R symmetric positive semidefinite.
void require_valid(const Setting& s);
/// @throws InvalidInput when there is not one n x n matrix of finite numbers per agent.
void require_gains(const Setting& s, const GainMatrices& K);

}  // namespace garrison::structural
