// SPDX-License-Identifier: Apache-2.0
// Random plants, sensors and averaging for the tests of the certificates, and noise at its bounds.
#pragma once

#include <algorithm>
#include <span>

#include "../random_system.hpp"

namespace garrison::test {

struct RandomNetwork {
  Matrix A, C, W;  // W: one round of averaging, row sums 1
  int rounds;
  double bw;
  Vector bv;
  Network graph;

  int N() const { return static_cast<int>(C.rows()); }
  int n() const { return static_cast<int>(A.rows()); }
  Matrix J() const {
    Matrix J = Matrix::Identity(N(), N());
    for (int k = 0; k < rounds; ++k) J = W * J;
    return J;
  }
};

inline Vector unit_vector(Rng& rng, int n) {
  Vector v = normal_matrix(rng, n, 1);
  return v / v.norm();
}

/// ||A|| = norm; every tenth agent has no sensor.
inline RandomNetwork random_network(Rng& rng, double norm, int rounds) {
  const int n = whole(rng, 1, 3);
  const int N = whole(rng, 4, 8);
  Matrix A = Matrix::Identity(n, n) + 0.3 * normal_matrix(rng, n, n);
  A *= norm / Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
  Matrix C(N, n);
  for (int i = 0; i < N; ++i) {
    C.row(i) = unit_vector(rng, n).transpose();
    if (whole(rng, 0, 9) == 0) C.row(i).setZero();
  }
  Network graph = connected_network(rng, N, 0.5);
  Matrix laplacian = Matrix::Zero(N, N);
  for (const auto& [i, j] : graph.edges()) {
    laplacian(i, i) += 1.0;
    laplacian(j, j) += 1.0;
    laplacian(i, j) -= 1.0;
    laplacian(j, i) -= 1.0;
  }
  const auto [least, most] = graph.laplacian_spectrum();
  const double noise = std::pow(10.0, uniform(rng, -2.0, 0.0));
  Vector bv(N);
  for (double& b : bv) b = noise * uniform(rng, 0.2, 2.0);
  return {A,
          C,
          Matrix::Identity(N, N) - 2.0 / (least + most) * laplacian,
          rounds,
          noise * uniform(rng, 0.0, 1.0),
          bv,
          graph};
}

inline double sign(Rng& rng) { return whole(rng, 0, 1) == 0 ? -1.0 : 1.0; }

/// `count` different numbers out of 0..of-1.
inline std::vector<int> choose(Rng& rng, int count, int of) {
  std::vector<int> all(static_cast<std::size_t>(of));
  for (int k = 0; k < of; ++k) all[static_cast<std::size_t>(k)] = k;
  std::shuffle(all.begin(), all.end(), rng);
  all.resize(static_cast<std::size_t>(std::min(count, of)));
  return all;
}

inline bool contains(std::span<const int> set, int id) {
  return std::find(set.begin(), set.end(), id) != set.end();
}

}  // namespace garrison::test
