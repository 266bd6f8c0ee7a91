// SPDX-License-Identifier: Apache-2.0
// How innovations are correlated in time.
#include "garrison/filters/structural/detection.hpp"

namespace garrison::structural {

std::vector<Matrix> innovation_covariances(const Setting& s, const GainMatrices& K, const Stationary& x,
                                           int lags) {
  using Index = Eigen::Index;
  const Index n = s.n();
  const Index N = s.N();
  const ErrorDynamics d = error_dynamics(s, K);
  Matrix Cb = Matrix::Zero(N, N * n);
  for (Index i = 0; i < N; ++i) Cb.block(i, i * n, 1, n) = s.C.row(i);
  // The error before the update, e-(k+1) = (W kron A) e(k) + 1 kron nu(k), and its covariance.
  Matrix B(N * n, N * n);
  Matrix prior(N * n, N * n);
  for (Index i = 0; i < N; ++i)
    for (Index j = 0; j < N; ++j) {
      B.block(i * n, j * n, n, n) = s.W(i, j) * s.A;
      prior.block(i * n, j * n, n, n) = s.E;
    }
  prior += B * x.Q * B.transpose();
  std::vector<Matrix> all{Cb * prior * Cb.transpose() + s.R};
  // cov(e(k+h), innovation(k)), from e(k) = (I - Kb D) e-(k) - Kb Db zeta(k).
  Matrix V = d.reduction * prior * Cb.transpose() - d.injection * s.R;
  for (int h = 1; h <= lags; ++h) {
    all.push_back(Cb * (B * V));
    V = d.Ahat * V;
  }
  return all;
}

}  // namespace garrison::structural
