// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/analysis.hpp"

#include <algorithm>

#include "core/solvers.hpp"
#include "core/spectrum.hpp"

namespace garrison::rdkf {
namespace {

constexpr double kRadiusMargin = 1e-9;
/// The stacked error matrix is dense: beyond this size radii and persistent bound are left out (NaN).
constexpr int kMostStacked = 1000;

/// Terms of the series that are summed before what is left is bounded: few for big networks.
int most_terms(int N, int n) {
  return static_cast<int>(std::clamp(1e7 / (1.0 * N * N * n * n), 32.0, 5000.0));
}

double norm2(const Matrix& m) {
  return m.size() == 0 ? 0.0 : Eigen::JacobiSVD<Matrix>(m).singularValues()(0);
}

/// Largest lambda with det(S - lambda B) = 0, B positive definite.
double pencil_max(const Matrix& S, const Matrix& B) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(S, B, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

Matrix inverse(const Matrix& S) { return Eigen::LLT<Matrix>(S).solve(Matrix::Identity(S.rows(), S.cols())); }

/// Blocks left_i Pbar_j^-1 A / d_i for j in N_i, stacked Nn x Nn.
Matrix error_matrix(const Setting& s, const SteadyState& steady, const std::vector<Matrix>& left) {
  const auto n = s.states();
  Matrix T = Matrix::Zero(n * s.agents(), n * s.agents());
  for (int i = 0; i < s.agents(); ++i) {
    const auto& heard = s.neighbours[static_cast<std::size_t>(i)];
    for (const int j : heard)
      T.block(i * n, j * n, n, n) = left[static_cast<std::size_t>(i)] *
                                    Eigen::LLT<Matrix>(steady.Pbar[static_cast<std::size_t>(j)]).solve(s.A) /
                                    static_cast<double>(heard.size());
  }
  return T;
}

std::vector<Matrix> inverses(const std::vector<Matrix>& all) {
  std::vector<Matrix> out;
  for (const Matrix& m : all) out.push_back(inverse(m));
  return out;
}

Matrix block_norms(const Matrix& T, int N, int n) {
  Matrix norms(N, N);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      const Matrix block = T.block(i * n, j * n, n, n);
      norms(i, j) = block.isZero(0.0) ? 0.0 : norm2(block);
    }
  return norms;
}

/// sum over m of sum over j ||[T^m]_ij B_j||, an upper bound: what `most_terms` leave is bounded by
/// squarings.
Vector series(const Matrix& T, const std::vector<Matrix>& B, int N, int n) {
  Vector sum = Vector::Zero(N);
  Matrix power = Matrix::Identity(T.rows(), T.cols());
  Matrix norms;
  const int terms = most_terms(N, n);
  for (int m = 0; m < terms; ++m) {
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        const Matrix& one = B[static_cast<std::size_t>(j)];
        if (one.size() != 0) sum(i) += norm2(power.block(i * n, j * n, n, n) * one);
      }
    power = power * T;
    if (m % 16 != 15) continue;
    norms = block_norms(power, N, n);
    if (norms.rowwise().sum().maxCoeff() <= 0.5) break;
  }
  // The terms from m on are [T^m]_il times those from 0 on: sum_total <= sum + norms sum_total.
  for (int squaring = 0; squaring < 60; ++squaring) {
    norms = block_norms(power, N, n);
    if (norms.rowwise().sum().maxCoeff() <= 0.5)
      return (Matrix::Identity(N, N) - norms).partialPivLu().solve(sum) * (1.0 + 1e-9);
    sum += norms * sum;
    power = power * power;
  }
  return Vector::Constant(N, kInfinity);
}

/// Refuses the covariances of another network.
void require_same(const Setting& s, const SteadyState& steady) {
  const auto agents = static_cast<int>(steady.P.size());
  const auto n = agents == 0 ? 0 : static_cast<int>(steady.P.front().rows());
  if (agents != s.agents() || n != s.states())
    refuse("steady", amount(agents, "agent") + " with " + amount(n, "state"),
           std::to_string(s.agents()) + " with " + std::to_string(s.states()) + ", as the setting has");
}

}  // namespace

double deviation_bound(const Setting& s, const SteadyState& steady, int i, double lambda, Penalty penalty) {
  const auto k = static_cast<std::size_t>(i);
  const Eigen::LLT<Matrix> Q(steady.Q[k]);
  double sum = 0.0;
  switch (penalty) {
    case Penalty::norm:
    case Penalty::huber:
      return lambda / 2.0 * norm2(Q.solve(s.M[k].transpose()));
    case Penalty::l1: {
      const Matrix columns = Q.solve(s.M[k].transpose());
      for (Eigen::Index m = 0; m < columns.cols(); ++m) sum += columns.col(m).norm();
      // Where rows are missing a correlated sensor has another root, and only the second bound never grows.
      const double all = std::sqrt(static_cast<double>(columns.cols())) * norm2(columns);
      return lambda / 2.0 * (s.Sv[k].isDiagonal(0.0) ? std::min(sum, all) : all);
    }
    case Penalty::group:
      for (const int j : s.neighbours[k]) sum += norm2(Q.solve(s.M[static_cast<std::size_t>(j)].transpose()));
      return lambda / 2.0 * sum;
  }
  return kNaN;
}

std::vector<double> prior_error_norms(const Setting& s, const SteadyState& steady, int agent) {
  const auto k = static_cast<std::size_t>(agent);
  const Eigen::LLT<Matrix> Q(steady.Q[k] * static_cast<double>(s.neighbours[k].size()));
  std::vector<double> norms;
  for (const int j : s.neighbours[k])
    norms.push_back(norm2(Q.solve(Eigen::LLT<Matrix>(steady.Pbar[static_cast<std::size_t>(j)]).solve(s.A))));
  return norms;
}

double scalar_basin(const Setting& s, const SteadyState& steady, double lambda) {
  require_same(s, steady);
  if (s.agents() != 1 || s.states() != 1) return kNaN;
  const double a = std::abs(s.A(0, 0));
  return a > 1.0 ? deviation_bound(s, steady, 0, lambda, Penalty::norm) / (a - 1.0) : kInfinity;
}

double lyapunov(const SteadyState& steady, const MatrixRef& errors) {
  const auto agents = static_cast<Eigen::Index>(steady.P.size());
  const Eigen::Index n = agents == 0 ? 0 : steady.P.front().rows();
  if (errors.rows() != n || errors.cols() != agents)
    refuse("errors", amount(errors.cols(), "agent") + " with " + amount(errors.rows(), "state"),
           amount(agents, "agent") + " with " + amount(n, "state"));
  double largest = 0.0;
  for (std::size_t i = 0; i < steady.P.size(); ++i) {
    const Vector e = errors.col(static_cast<Eigen::Index>(i));
    largest = std::max(largest, e.dot(Eigen::LLT<Matrix>(steady.P[i]).solve(e)));
  }
  return largest;
}

Constants constants(const Setting& s, const SteadyState& steady, double lambda, Penalty penalty) {
  const int N = s.agents();
  require_same(s, steady);
  if (!(lambda >= 0.0)) refuse("weight (lambda)", text(lambda), "a number >= 0");
  Constants c;
  c.resiliency_bound = c.prior_deviation_bound = c.refined_threshold = Vector::Zero(N);
  c.level = {kInfinity, kInfinity, kInfinity};
  c.rate = 0.0;
  c.eta = 0.0;
  for (int i = 0; i < N; ++i) {
    const auto k = static_cast<std::size_t>(i);
    c.prior_deviation_bound(i) = deviation_bound(s, steady, i, lambda, penalty);
    c.resiliency_bound(i) = 2.0 * c.prior_deviation_bound(i);
    const Matrix& M = s.M[k];
    const Matrix moved = s.A.transpose() * Eigen::LLT<Matrix>(steady.Pbar[k]).solve(s.A);
    const Matrix symmetric = 0.5 * (moved + moved.transpose());
    const Matrix S = garrison::detail::covariance_root(
        steady.P[k]);  // P^-1 of precise measurements holds nothing but these
    const Matrix relative = S.transpose() * symmetric * S;
    c.rate = std::max(
        c.rate,
        Eigen::SelfAdjointEigenSolver<Matrix>(relative, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
    c.eta = std::max(c.eta, pencil_max(symmetric, steady.Q[k]));
    c.refined_threshold(i) = kInfinity;
    if (M.rows() == 0) continue;
    const Matrix G = M * Eigen::LLT<Matrix>(steady.Q[k]).solve(M.transpose());
    const Vector values = Eigen::SelfAdjointEigenSolver<Matrix>(G, Eigen::EigenvaluesOnly).eigenvalues();
    const double rounding = 1e-14 * static_cast<double>(G.rows()) * std::max(values.maxCoeff(), 0.0);
    const double kappa = M.rows() > M.cols() || values(0) <= rounding ? 0.0 : values(0);
    c.refined_threshold(i) = lambda / 2.0 * (1.0 + std::sqrt(1.0 + kappa));
    const double most = std::max(values.maxCoeff(), 0.0);
    const double spread = std::sqrt(most / (1.0 + most));  // of M P M' = G (I + G)^-1
    if (spread == 0.0) continue;
    const auto reach = [&](double t) { return t * t / (spread * spread); };
    c.level.printed = std::min(c.level.printed, reach(2.0 * lambda));
    c.level.corrected = std::min(c.level.corrected, reach(lambda));
    c.level.refined = std::min(c.level.refined, reach(c.refined_threshold(i)));
  }
  if (penalty != Penalty::norm) {
    c.level = {kNaN, kNaN, kNaN};
    c.refined_threshold.setConstant(kNaN);
  }
  c.dkf_error_radius = c.prior_error_radius = kNaN;
  c.persistent_bound = Vector::Constant(N, kNaN);
  if (N * s.states() > kMostStacked) return c;
  c.dkf_error_radius = spectral_radius(error_matrix(s, steady, steady.P));
  const std::vector<Matrix> Qinv = inverses(steady.Q);
  const Matrix T0 = error_matrix(s, steady, Qinv);
  c.prior_error_radius = spectral_radius(T0);
  c.persistent_bound.setConstant(kInfinity);
  if (c.prior_error_radius >= 1.0 - kRadiusMargin) return c;
  std::vector<Matrix> push;
  for (int j = 0; j < N; ++j) {
    const auto k = static_cast<std::size_t>(j);
    if (penalty == Penalty::norm || penalty == Penalty::huber)
      push.push_back(lambda / 2.0 * Qinv[k] * s.M[k].transpose());
    else  // the push is any vector within a ball of the deviation bound
      push.push_back(c.prior_deviation_bound(j) * Matrix::Identity(s.states(), s.states()));
  }
  c.persistent_bound = series(T0, push, N, s.states());
  return c;
}

}  // namespace garrison::rdkf
