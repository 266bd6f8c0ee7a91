// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::partial_sharing {
namespace {

/// C_i [sum over neighbours j, r of (W o Sigma)_jr] C_i'
Matrix injected(const Setting& s, const LocalGains& g, int i, const Matrix& W, const Matrix& Sigma) {
  const int m = s.states();
  Matrix sum = Matrix::Zero(m, m);
  for (const int j : s.hears[static_cast<std::size_t>(i)])
    for (const int r : s.hears[static_cast<std::size_t>(i)]) {
      const auto block = Sigma.block(j * m, r * m, m, m);
      if (W.size() == 1)
        sum += W(0, 0) * block;
      else
        sum += W.block(j * m, r * m, m, m).cwiseProduct(block);
    }
  return g.C * sum * g.C.transpose();
}

Matrix local_noise(const Setting& s, const LocalGains& g, int i) {
  return g.K * s.R[static_cast<std::size_t>(i)] * g.K.transpose() + s.Q;
}

}  // namespace

std::vector<Matrix> local_covariances(const Setting& s, const std::vector<LocalGains>& gains, const Matrix& W,
                                      const Matrix& Sigma) {
  std::vector<Matrix> all;
  for (int i = 0; i < s.agents(); ++i) {
    const LocalGains& g = gains[static_cast<std::size_t>(i)];
    Matrix P = local_noise(s, g, i);
    if (Sigma.size() != 0) P += injected(s, g, i, W, Sigma);
    Matrix F = g.F;
    for (int k = 0; k < 64; ++k) {  // doubling
      const Matrix more = F * P * F.transpose();
      P += more;
      if (more.cwiseAbs().maxCoeff() <= 1e-18 * P.cwiseAbs().maxCoeff()) break;
      F = (F * F).eval();
    }
    all.emplace_back((P + P.transpose()) / 2.0);
  }
  return all;
}

double mse(const std::vector<Matrix>& covariances) {
  double sum = 0.0;
  for (const Matrix& P : covariances) sum += P.trace();
  return sum / static_cast<double>(covariances.size());
}

std::vector<double> recursion8(const Setting& s, const std::vector<LocalGains>& gains, const Matrix& Sigma,
                               std::int64_t k0, int steps) {
  std::vector<Matrix> P;
  for (const LocalGains& g : gains) P.push_back(g.P);
  std::vector<double> out;
  for (int k = 0; k < steps; ++k) {
    const Vector selected = s.selection.stacked(k0 + k);
    const Matrix W = selected * selected.transpose();
    for (int i = 0; i < s.agents(); ++i) {
      const LocalGains& g = gains[static_cast<std::size_t>(i)];
      Matrix& own = P[static_cast<std::size_t>(i)];
      own = (g.F * own * g.F.transpose() + local_noise(s, g, i)).eval();
      if (Sigma.size() != 0) own += injected(s, g, i, W, Sigma);
    }
    out.push_back(mse(P));
  }
  return out;
}

}  // namespace garrison::partial_sharing
