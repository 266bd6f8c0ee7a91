// SPDX-License-Identifier: Apache-2.0
// The linear error system of the saturated consensus filter (Lemma 1): informed, testing and isolated agents
// all obey it.
#pragma once

#include <span>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// E(t) = M E(t-1) + B_w w(t-1) + B (v(t) + a(t)), E stacked agent by agent, with Pi_l = I - C_l'C_l.
struct ErrorSystem {
  Matrix A;           ///< n x n
  Matrix C;           ///< N x n, rows of length 1, or 0: no sensor
  Matrix CA;          ///< C A, also for silent sensors
  Vector row_length;  ///< ||C_j||: 1 or 0
  Matrix M;           ///< Nn x Nn: M_il = J_il Pi_l A
  Matrix B;           ///< Nn x N: J_il C_l'
  Matrix B_w;         ///< Nn x n: -sum_l J_il Pi_l

  Eigen::Index agents() const { return C.rows(); }
  Eigen::Index states() const { return A.rows(); }
  auto block(const Matrix& stacked, Eigen::Index agent) const {
    return stacked.middleRows(agent * states(), states());
  }
};

/// A: n x n; C: N x n, one row per agent (agents with several outputs: split_outputs); J: N x N, the whole
/// averaging of one step, row sums 1, negative weights allowed; silent: sensors that inject nothing, their C
/// counts as 0 here.
/// @throws InvalidInput for wrong shapes, numbers that are not finite, rows that are neither of length 1 nor
/// 0 (to 1e-9), row sums of J that are not 1 (to 1e-9), a silent sensor out of range
GARRISON_EXPORT ErrorSystem error_system(const MatrixRef& A, const MatrixRef& C, const MatrixRef& J,
                                         std::span<const int> silent = {});

/// One step of the covariance of the noise part: M P M' + B_w Q B_w' + B diag(R) B'. Q: n x n; R: N
/// variances.
Matrix next_covariance(const ErrorSystem& system, const Matrix& P, const MatrixRef& Q, const VectorRef& R);

/// sqrt(lmax(P_ii)) of every agent, N numbers.
Vector block_deviations(const ErrorSystem& system, const Matrix& P);

}  // namespace garrison::certificate
