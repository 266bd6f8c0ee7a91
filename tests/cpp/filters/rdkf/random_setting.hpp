// SPDX-License-Identifier: Apache-2.0
// Random models with covariances for the tests of the resilient distributed Kalman filter.
#pragma once

#include "../../random_system.hpp"
#include "core/solvers.hpp"

namespace garrison::test {

inline Matrix definite(Rng& rng, int size, double scale) {
  const Matrix root = normal_matrix(rng, size, size);
  return scale * (root * root.transpose() + 0.3 * Matrix::Identity(size, size));
}

/// Agents with 0 to 4 sensors (the first has at least n, so that the pair is detectable), full covariances,
/// those of w different from agent to agent, and a spectral radius of A as given.
inline Model covariance_model(Rng& rng, int n, int agents, double radius, double process_bound = kNaN) {
  Matrix A = normal_matrix(rng, n, n);
  A *= radius / Eigen::EigenSolver<Matrix>(A, false).eigenvalues().cwiseAbs().maxCoeff();
  std::vector<Matrix> C;
  Noise noise;
  noise.process_bound = process_bound;
  for (int i = 0; i < agents; ++i) {
    const int q = i == 0 ? n : whole(rng, 0, 4);
    C.push_back(normal_matrix(rng, q, n));
    noise.measurement_covariance.push_back(q == 0 ? Matrix(0, 0) : definite(rng, q, 0.5));
    noise.agent_process_covariance.push_back(definite(rng, n, 0.3));
  }
  return {A, C, noise};
}

}  // namespace garrison::test
