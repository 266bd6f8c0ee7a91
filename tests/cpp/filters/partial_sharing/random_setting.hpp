// SPDX-License-Identifier: Apache-2.0
// Random problems for the tests of the partial-sharing filter.
#pragma once

#include "../../random_system.hpp"
#include "core/solvers.hpp"
#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::test {

inline Matrix covariance(Rng& rng, int size, double scale) {
  const Matrix G = normal_matrix(rng, size, size);
  return scale * (G * G.transpose() / size + 0.1 * Matrix::Identity(size, size));
}

struct SharingOptions {
  double radius = 0.9;       // spectral radius of A
  double measurement = 1.0;  // scale of R
  bool directed = false;
  bool sensors_everywhere = true;
};

/// A detectable model (m sensor rows per agent) and a network.
inline std::pair<Model, Network> sharing_problem(Rng& rng, int m, int N, const SharingOptions& o = {}) {
  Matrix A = normal_matrix(rng, m, m);
  A *= o.radius / std::max(A.eigenvalues().cwiseAbs().maxCoeff(), 1e-6);
  std::vector<Matrix> H, R;
  for (int i = 0; i < N; ++i) {
    const int rows = o.sensors_everywhere || i % 3 != 1 ? m : 0;
    H.push_back(normal_matrix(rng, rows, m));
    R.push_back(rows == 0 ? Matrix(0, 0) : covariance(rng, rows, o.measurement));
  }
  Noise noise;
  noise.process_covariance = covariance(rng, m, 0.2);
  noise.measurement_covariance = R;
  Network net = connected_network(rng, N);
  if (o.directed) {
    std::vector<Edge> edges = net.edges();
    for (auto& [a, b] : edges)
      if (uniform(rng, 0, 1) < 0.5) std::swap(a, b);
    net = Network(N, edges, true);
  }
  return {Model(A, H, noise), net};
}

inline partial_sharing::Setting sharing_setting(Rng& rng, int m, int N, double gain,
                                                const SharingOptions& o = {}) {
  const auto [model, net] = sharing_problem(rng, m, N, o);
  PartialSharing::Params p;
  p.gain = gain;
  p.shared = whole(rng, 1, m);
  p.selection_seed = whole(rng, 0, 1000);
  p.shift = whole(rng, -3, 3);
  p.start_is_prediction = true;
  return partial_sharing::make_setting(p, model, net);
}

}  // namespace garrison::test
