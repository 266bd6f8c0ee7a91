// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/kernels.hpp"

#include <cmath>

#include "core/solvers.hpp"
#include "garrison/kernel/hypotenuse.hpp"
#include "require.hpp"

namespace garrison::certificate {
namespace {

/// Norms of the n x n blocks, and of C_j A times them.
void block_norms(const ErrorSystem& s, const Matrix& P, Gains& Rb, Gains& Re) {
  const Eigen::Index n = s.states();
  for (Eigen::Index i = 0; i < s.agents(); ++i)
    for (Eigen::Index l = 0; l < s.agents(); ++l) {
      const auto block = P.block(i * n, l * n, n, n);
      Rb(i, l) = spectral_norm(block);
      Re(i, l) = (s.CA.row(i) * block).stableNorm();
    }
}

/// What unit inputs of the sensors (G = M^k B) do.
void column_norms(const ErrorSystem& s, const Matrix& G, Gains& gb, Gains& ge) {
  for (Eigen::Index i = 0; i < s.agents(); ++i)
    for (Eigen::Index l = 0; l < s.agents(); ++l) {
      const auto column = s.block(G, i).col(l);
      gb(i, l) = column.stableNorm();
      ge(i, l) = std::abs(s.CA.row(i).dot(column));
    }
}

}  // namespace

double spectral_norm(const MatrixRef& block) {
  const double scale = block.size() == 0 ? 0.0 : block.cwiseAbs().maxCoeff();
  if (scale == 0.0) return 0.0;
  if (block.size() == 1) return scale;
  const Matrix scaled = block / scale;
  const Matrix gram =
      block.rows() < block.cols() ? Matrix(scaled * scaled.transpose()) : Matrix(scaled.transpose() * scaled);
  if (gram.rows() == 2) {  // closed form: designs ask for millions of them
    const double half = 0.5 * (gram(0, 0) - gram(1, 1));
    return scale * std::sqrt(0.5 * (gram(0, 0) + gram(1, 1)) + hypotenuse(half, gram(0, 1)));
  }
  const auto values = Eigen::SelfAdjointEigenSolver<Matrix>(gram, Eigen::EigenvaluesOnly).eigenvalues();
  return scale * std::sqrt(values(values.size() - 1));
}

Kernels kernels(const ErrorSystem& s, int window) {
  detail::require_least("window", window, 1);
  const Eigen::Index N = s.agents();
  detail::require_room("window", 4.0 * (window + 1.0) * static_cast<double>(N * N));
  const auto K = static_cast<std::size_t>(window);
  Kernels k{s, {}, {}, Gains(window, N), Gains(window, N), {}, {}};
  for (auto* gains : {&k.gb, &k.ge}) gains->assign(K, Gains(N, N));
  for (auto* gains : {&k.Rb, &k.Re}) gains->assign(K + 1, Gains(N, N));
  Matrix power = Matrix::Identity(s.M.rows(), s.M.cols());
  for (std::size_t lag = 0; lag <= K; ++lag) {
    if (!power.allFinite())
      refuse("window", std::to_string(window), "powers of M that are finite",
             "the errors explode; take less");
    block_norms(s, power, k.Rb[lag], k.Re[lag]);
    if (lag == K) break;
    column_norms(s, power * s.B, k.gb[lag], k.ge[lag]);
    const Matrix W = power * s.B_w;
    for (Eigen::Index i = 0; i < N; ++i) {
      k.wb(static_cast<Eigen::Index>(lag), i) = spectral_norm(s.block(W, i));
      k.we(static_cast<Eigen::Index>(lag), i) = (s.CA.row(i) * s.block(W, i)).stableNorm();
    }
    power = s.M * power;
  }
  return k;
}

}  // namespace garrison::certificate
