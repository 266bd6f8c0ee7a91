// SPDX-License-Identifier: Apache-2.0
// Random plants and networks for tests.
#pragma once

#include <random>
#include <vector>

#include "core/solvers.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"

namespace garrison::test {

using Rng = std::mt19937_64;

/// Of so many random cases those that are tried: a tenth under the sanitizers, which look for other mistakes
/// and take twenty times as long for the same.
constexpr int tried(int cases) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return cases / 10;
#else
  return cases;
#endif
}

inline double uniform(Rng& rng, double low, double high) {
  return std::uniform_real_distribution(low, high)(rng);
}
inline int whole(Rng& rng, int low, int high) { return std::uniform_int_distribution(low, high)(rng); }

inline Matrix normal_matrix(Rng& rng, int rows, int columns) {
  std::normal_distribution<double> normal;
  return Matrix::NullaryExpr(rows, columns, [&] { return normal(rng); });
}

/// A plant with ||A|| = norm and one unit row per agent; bounds of the noise, and covariances.
inline Model scalar_model(Rng& rng, int n, int agents, double norm, double b_w, double b_v) {
  Matrix A = Matrix::Identity(n, n) + 0.3 * normal_matrix(rng, n, n);
  A *= norm / Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
  std::vector<Matrix> C;
  for (int i = 0; i < agents; ++i) {
    Matrix row = normal_matrix(rng, 1, n);
    C.push_back(row / row.norm());
  }
  const Matrix Sw = 0.04 * Matrix::Identity(n, n);  // for families that weigh; nothing is drawn from it
  const std::vector<Matrix> Sv(static_cast<std::size_t>(agents), Matrix::Constant(1, 1, 0.1));
  return {A, C, {b_w, Vector::Constant(agents, b_v), Sw, Sv}};
}

/// A connected graph: a random tree and some more edges.
inline Network connected_network(Rng& rng, int agents, double extra = 0.3) {
  std::vector<Edge> edges;
  for (int i = 1; i < agents; ++i) edges.emplace_back(whole(rng, 0, i - 1), i);
  for (int i = 0; i < agents; ++i)
    for (int j = i + 1; j < agents; ++j)
      if (uniform(rng, 0, 1) < extra) edges.emplace_back(i, j);
  return {agents, edges};
}

}  // namespace garrison::test
