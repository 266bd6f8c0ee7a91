// SPDX-License-Identifier: Apache-2.0
#include "core/solvers.hpp"
#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::partial_sharing {
namespace {

/// Gains of agent i from the network covariance.
LocalGains gains_of(const Setting& s, int i, const Matrix& P, const Matrix& selected) {
  const int m = s.states();
  const auto at = static_cast<std::size_t>(i);
  const Matrix& H = s.H[at];
  LocalGains g;
  g.P = P.block(i * m, i * m, m, m);
  const Eigen::LLT<Matrix> M(s.R[at] + H * g.P * H.transpose());
  const auto times_inverse = [&](const Matrix& X) {  // X H' M^-1
    return H.rows() == 0 ? Matrix(m, 0) : Matrix(M.solve(H * X.transpose()).transpose());
  };
  const Matrix K = times_inverse(s.A * g.P);
  g.C = s.gamma * (s.A - K * H) * g.P;
  Matrix inner = s.A * g.P;
  for (const int j : s.hears[at]) {
    const Matrix CS = g.C * selected.row(j).asDiagonal();
    inner += CS * (P.block(j * m, i * m, m, m) - g.P);
  }
  g.K = times_inverse(inner);
  g.F = s.A - g.K * H;
  return g;
}

void require(const char* which, const MatrixRef& given, Eigen::Index rows, Eigen::Index columns) {
  if (given.rows() == rows && given.cols() == columns) return;
  refuse(which, std::to_string(given.rows()) + " x " + std::to_string(given.cols()),
         std::to_string(rows) + " x " + std::to_string(columns));
}

}  // namespace

FullSolution full_solution(const Setting& s, int steps, const MatrixRef& start, const MatrixRef& y,
                           const MatrixRef& delta, const Matrix& Sigma, std::int64_t k0, bool common) {
  const int m = s.states();
  const int N = s.agents();
  Eigen::Index outputs = 0;
  for (const Matrix& H : s.H) outputs += H.rows();
  require("start", start, N, m);
  if (y.rows() != 0) require("y", y, steps, outputs);
  if (delta.rows() != 0) require("delta", delta, steps, s.size());
  FullSolution out;
  out.P = Matrix::Zero(s.size(), s.size());
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j)
      if (common || i == j) out.P.block(i * m, j * m, m, m) = s.P0;
  Matrix known = out.P;  // what the gains are made from: nobody knows Sigma
  out.estimate.push_back(start);
  out.trace.push_back(out.P.trace());
  for (int k = 0; k < steps; ++k) {
    const Matrix selected = s.selection.at(k);
    std::vector<LocalGains> gains;
    for (int i = 0; i < N; ++i) gains.push_back(gains_of(s, i, known, selected));
    const Matrix& x = out.estimate.back();
    Matrix next = x * s.A.transpose();
    Eigen::Index first = 0;
    for (int i = 0; i < N && y.rows() != 0; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Vector own = x.row(i);
      Vector seen = gains[at].K * (y.row(k).segment(first, s.H[at].rows()).transpose() - s.H[at] * own);
      first += s.H[at].rows();
      Vector u = Vector::Zero(m);
      for (const int j : s.hears[at]) {
        Vector sent = x.row(j);
        if (delta.rows() != 0) sent += delta.row(k).segment(static_cast<Eigen::Index>(j) * m, m).transpose();
        u += selected.row(j).transpose().cwiseProduct(sent - own);
      }
      next.row(i) += (seen + gains[at].C * u).transpose();
    }
    out.P = covariance_step(s, gains, k, out.P, k >= k0 ? Sigma : Matrix());
    known = covariance_step(s, gains, k, known, Matrix());
    out.estimate.push_back(next);
    out.trace.push_back(out.P.trace());
    out.K.clear();
    out.C.clear();
    for (const LocalGains& g : gains) {
      out.K.push_back(g.K);
      out.C.push_back(g.C);
    }
  }
  return out;
}

}  // namespace garrison::partial_sharing
