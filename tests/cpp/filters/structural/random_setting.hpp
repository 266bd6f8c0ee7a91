// SPDX-License-Identifier: Apache-2.0
// Random settings of the structural filter.
#pragma once

#include "../../random_system.hpp"
#include "garrison/filters/structural/setting.hpp"

namespace garrison::test {

/// n states, N agents, a strongly connected random network; every covariance positive definite, correlated.
inline structural::Setting random_setting(Rng& rng, int n, int N, double growth) {
  structural::Setting s;
  s.A = normal_matrix(rng, n, n);
  s.A *= growth / Eigen::JacobiSVD<Matrix>(s.A).singularValues()(0);
  s.C = normal_matrix(rng, N, n);
  s.W = Matrix::Zero(N, N);
  s.U = Matrix::Identity(N, N);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      if (i == j || (i + 1) % N == j || uniform(rng, 0, 1) < 0.3) s.W(i, j) = uniform(rng, 0.1, 1.0);
      if (uniform(rng, 0, 1) < 0.4) s.U(i, j) = 1.0;
    }
  for (int i = 0; i < N; ++i) s.W.row(i) /= s.W.row(i).sum();
  const Matrix G = normal_matrix(rng, n, n);
  s.E = 0.01 * (G * G.transpose() + Matrix::Identity(n, n));
  const Matrix H = normal_matrix(rng, N, N);
  s.R = 0.01 * (H * H.transpose() / N + Matrix::Identity(N, N));
  s.E = 0.5 * (s.E + s.E.transpose()).eval();
  s.R = 0.5 * (s.R + s.R.transpose()).eval();
  return s;
}

}  // namespace garrison::test
