// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/steady_state.hpp"

#include "core/solvers.hpp"

namespace garrison::rdkf {
namespace {

constexpr double kGrown = 1e14;
/// Rounding may keep the change above the tolerance: sweeps without progress after which a small change
/// counts.
constexpr int kPatience = 30;
constexpr double kSmallChange = 1e-10;

Matrix inverse(const Matrix& S) {
  const Matrix inv = Eigen::LLT<Matrix>(S).solve(Matrix::Identity(S.rows(), S.cols()));
  return 0.5 * (inv + inv.transpose());
}

Matrix predicted(const Setting& s, std::size_t j, const Matrix& P) {
  const Matrix half = s.A * P;
  const Matrix Pbar = half * s.A.transpose() + s.Sw[j];
  return 0.5 * (Pbar + Pbar.transpose());
}

/// (1/d_i) sum over N_i of Pbar_j^-1 for every agent.
std::vector<Matrix> fused(const Setting& s, const std::vector<Matrix>& P) {
  std::vector<Matrix> information;
  for (std::size_t j = 0; j < P.size(); ++j) information.push_back(inverse(predicted(s, j, P[j])));
  std::vector<Matrix> Q;
  for (const auto& heard : s.neighbours) {
    Matrix sum = Matrix::Zero(s.states(), s.states());
    for (const int j : heard) sum += information[static_cast<std::size_t>(j)];
    Q.push_back(sum / static_cast<double>(heard.size()));
  }
  return Q;
}

std::vector<Matrix> sweep(const Setting& s, const std::vector<Matrix>& seen, const std::vector<Matrix>& P) {
  std::vector<Matrix> next = fused(s, P);
  for (std::size_t i = 0; i < next.size(); ++i) next[i] = inverse(next[i] + seen[i]);
  return next;
}

/// C_i' Sv_i^-1 C_i
std::vector<Matrix> measured(const Setting& s) {
  std::vector<Matrix> all;
  for (const Matrix& M : s.M) all.push_back(M.transpose() * M);
  return all;
}

void require_start(const Setting& s, const std::vector<Matrix>& P) {
  if (static_cast<int>(P.size()) != s.agents())
    refuse("P", std::to_string(P.size()) + " matrices", std::to_string(s.agents()) + ", one per agent");
  for (std::size_t i = 0; i < P.size(); ++i)
    if (P[i].rows() != s.states() || P[i].cols() != s.states() || !P[i].allFinite())
      refuse("P[" + std::to_string(i) + "]",
             std::to_string(P[i].rows()) + " x " + std::to_string(P[i].cols()) + " or not finite",
             "a finite positive semidefinite matrix, as many rows as states");
}

}  // namespace

std::vector<Matrix> riccati_sweep(const Setting& s, const std::vector<Matrix>& P) {
  require_start(s, P);
  return sweep(s, measured(s), P);
}

SteadyState steady_state(const Setting& s, const SteadyOptions& options) {
  const auto N = static_cast<std::size_t>(s.agents());
  const auto n = s.states();
  const std::vector<Matrix> seen = measured(s);
  SteadyState out;
  out.P = options.start.empty() ? std::vector<Matrix>(N, Matrix::Zero(n, n)) : options.start;
  require_start(s, out.P);
  double best = kInfinity;
  int since_best = 0;
  for (out.sweeps = 1;; ++out.sweeps) {
    std::vector<Matrix> next = sweep(s, seen, out.P);
    out.change = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      const double size = next[i].cwiseAbs().maxCoeff();
      if (!(size <= kGrown))
        refuse("model", "covariances that grow beyond 1e14",
               "a pair (A, C) that is detectable with some margin",
               "equation (5) has no usable solution: agent " + std::to_string(i) +
                   " hardly learns of a mode that does not decay");
      out.change = std::max(out.change, (next[i] - out.P[i]).cwiseAbs().maxCoeff() / size);
    }
    out.P = std::move(next);
    since_best = out.change < best ? 0 : since_best + 1;
    best = std::min(best, out.change);
    if (out.change < options.tolerance || (since_best >= kPatience && best < kSmallChange)) break;
    if (out.sweeps >= options.most_sweeps)
      refuse("model",
             "covariances that still change by " + text(out.change) + " after " + std::to_string(out.sweeps) +
                 " sweeps",
             "a pair (A, C) that is detectable with some margin");
  }
  for (std::size_t j = 0; j < N; ++j) out.Pbar.push_back(predicted(s, j, out.P[j]));
  out.Q = fused(s, out.P);
  return out;
}

}  // namespace garrison::rdkf
