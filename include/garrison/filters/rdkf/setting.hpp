// SPDX-License-Identifier: Apache-2.0
// What the equations of the resilient distributed Kalman filter start from.
#pragma once

#include <vector>

#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"

namespace garrison::rdkf {

/// A model and a network whose covariances, connection and detectability have been checked.
struct GARRISON_EXPORT Setting {
  Matrix A;                                  ///< n x n
  std::vector<Matrix> C;                     ///< q_i x n
  std::vector<Matrix> Sv;                    ///< q_i x q_i, covariance of the measurement noise
  std::vector<Matrix> Sw;                    ///< n x n, what agent i takes for the covariance of w
  std::vector<Matrix> whitener;              ///< Sv_i^-1/2, the symmetric root
  std::vector<Matrix> M;                     ///< Sv_i^-1/2 C_i
  std::vector<std::vector<int>> neighbours;  ///< N_i: i itself and the agents it hears, sorted; d_i of them

  int agents() const { return static_cast<int>(C.size()); }
  int states() const { return static_cast<int>(A.rows()); }
};

/// @throws InvalidInput when a covariance is missing or not positive definite (a singular one of w breaks
/// uniqueness of (5), docs/filters/rdkf.md#r9), the network is not connected, or (A, C) is not detectable
GARRISON_EXPORT Setting setting(const Model& model, const Network& network);

/// The same for a part of a network: its agents, and those of others that they hear, without rows. Whether
/// the whole is connected and detectable cannot be seen from here, and is not asked.
Setting part_setting(const Model& model, const Network& network);

/// Every mode of A on or outside of the unit circle is surely seen by some row of C: visibility(A, C, 1) in
/// analysis/modes.hpp. A: n x n, C: m x n, m >= 0.
GARRISON_EXPORT bool detectable(const MatrixRef& A, const MatrixRef& C);

}  // namespace garrison::rdkf
