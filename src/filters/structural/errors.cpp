// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/structural/errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks.hpp"
#include "core/solvers.hpp"
#include "core/spectrum.hpp"
#include "garrison/analysis/lyapunov.hpp"

namespace garrison::structural {
namespace {

using Index = Eigen::Index;

double norm2(const Matrix& M) {
  if (M.size() == 0) return 0.0;
  const Matrix small = M.rows() < M.cols() ? Matrix(M * M.transpose()) : Matrix(M.transpose() * M);
  const Vector values = Eigen::SelfAdjointEigenSolver<Matrix>(small, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(std::max(0.0, values(values.size() - 1)));
}

/// Residuals of stacked errors: row i of Cb has c_i' in block i.
Matrix residual_map(const Setting& s) {
  Matrix Cb = Matrix::Zero(s.N(), s.N() * s.n());
  for (Index i = 0; i < s.N(); ++i) Cb.block(i, i * s.n(), 1, s.n()) = s.C.row(i);
  return Cb;
}

}  // namespace

ErrorDynamics error_dynamics(const Setting& s, const GainMatrices& K) {
  require_graphs(s);
  require_gains(s, K);
  const Index n = s.n();
  const Index N = s.N();
  ErrorDynamics d;
  d.reduction = Matrix::Identity(N * n, N * n);
  d.Ahat.resize(N * n, N * n);
  d.injection = Matrix::Zero(N * n, N);
  for (Index i = 0; i < N; ++i) {
    const Matrix& Ki = K[static_cast<std::size_t>(i)];
    const Matrix reduction = Matrix::Identity(n, n) - Ki * detail::seen(s, i);
    const Matrix reducedA = reduction * s.A;
    d.reduction.block(i * n, i * n, n, n) = reduction;
    for (Index j = 0; j < N; ++j) {
      d.Ahat.block(i * n, j * n, n, n) = s.W(i, j) * reducedA;
      if (s.U(i, j) != 0.0) d.injection.block(i * n, j, n, 1) = Ki * s.C.row(j).transpose();
    }
  }
  return d;
}

Stationary stationary(const Setting& s, const GainMatrices& K, int lags) {
  require_valid(s);
  if (lags < 0) refuse("lags", std::to_string(lags), "at least 0");
  require_memory("lags", std::to_string(lags), 8.0 * lags * static_cast<double>(s.N() * s.N()));
  const ErrorDynamics d = error_dynamics(s, K);
  Stationary x;
  x.rho = spectral_radius(d.Ahat);
  if (!(x.rho < 1.0))
    refuse("spectral radius of the error matrix", text(x.rho), "below 1 (Schur stable)",
           "with these gains the error has no steady covariance; design other gains, or take smaller "
           "self-weights W_ii");
  const Index n = s.n();
  const Index N = s.N();
  // (12) with the process noise common to all agents: F = G E G' + Kb Db R (Kb Db)', G = (I - Kb D)(1 kron
  // I).
  Matrix G(N * n, n);
  for (Index i = 0; i < N; ++i) G.middleRows(i * n, n) = d.reduction.block(i * n, i * n, n, n);
  const Matrix F = G * s.E * G.transpose() + d.injection * s.R * d.injection.transpose();
  x.Q = lyapunov(d.Ahat, F);
  const Matrix Cb = residual_map(s);
  const Matrix noise = d.injection * s.R;  // -cov(e, zeta)
  Matrix V = x.Q * Cb.transpose() - noise;
  x.covariances.push_back(Cb * V - noise.transpose() * Cb.transpose() + s.R);
  for (int h = 1; h <= lags; ++h) {
    V = d.Ahat * V;
    x.covariances.push_back(Cb * V);
  }
  x.residual_std = x.covariances.front().diagonal().cwiseMax(0.0).cwiseSqrt();
  x.innovation_std.resize(N);
  for (Index i = 0; i < N; ++i) {
    Matrix mixed = Matrix::Zero(n, n);
    for (Index j = 0; j < N; ++j)
      for (Index l = 0; l < N; ++l)
        if (s.W(i, j) != 0.0 && s.W(i, l) != 0.0)
          mixed += s.W(i, j) * s.W(i, l) * x.Q.block(j * n, l * n, n, n);
    const Matrix prior = s.A * mixed * s.A.transpose() + s.E;
    x.innovation_std(i) = std::sqrt(std::max(0.0, s.C.row(i).dot(s.C.row(i) * prior) + s.R(i, i)));
  }
  const Eigen::PartialPivLU<Matrix> steady(Matrix(Matrix::Identity(N * n, N * n) - d.Ahat));
  x.dc_error = -steady.solve(d.injection);
  x.dc_gain = Matrix::Identity(N, N) + Cb * x.dc_error;
  // An attack that no test ever sees has a response of 0: what rounding leaves of it is none, either.
  const Matrix terms =
      Matrix::Ones(N, N) + Cb.cwiseAbs().rowwise().sum() * x.dc_error.cwiseAbs().colwise().maxCoeff();
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() / steady.rcond();
  x.dc_gain = (x.dc_gain.array().abs() <= rounding * terms.array()).select(0.0, x.dc_gain);
  return x;
}

Matrix step_response(const Setting& s, const GainMatrices& K, int agent, int rows) {
  const ErrorDynamics d = error_dynamics(s, K);
  if (agent < 0 || agent >= s.N())
    refuse("agent", std::to_string(agent), "an agent in 0.." + std::to_string(s.N() - 1));
  if (rows < 0) refuse("rows", std::to_string(rows), "at least 0");
  require_memory("rows", std::to_string(rows), 8.0 * rows * static_cast<double>(s.N()));
  const Matrix Cb = residual_map(s);
  Vector e = Vector::Zero(d.Ahat.rows());
  Matrix r(rows, s.N());
  for (int k = 0; k < rows; ++k) {
    e = d.Ahat * e - d.injection.col(agent);
    r.row(k) = Cb * e + Vector::Unit(s.N(), agent);
  }
  return r;
}

Matrix isolation_ratios(const Setting& s, const GainMatrices& K) {
  require_gains(s, K);
  Matrix ratio = Matrix::Zero(s.N(), s.N());
  const auto reaction = [&](Index i, Index j) {
    return s.C.row(i).dot(K[static_cast<std::size_t>(i)] * s.C.row(j).transpose());
  };
  for (Index j = 0; j < s.N(); ++j) {
    const double own = std::abs(reaction(j, j) - 1.0);
    for (Index i = 0; i < s.N(); ++i)
      if (i != j) ratio(i, j) = own == 0.0 ? kInfinity : std::abs(reaction(i, j)) / own;
  }
  return ratio;
}

Matrix predictions(const Setting& s, const MatrixRef& estimates) {
  if (estimates.rows() != s.N() || estimates.cols() != s.n())
    refuse("estimates", std::to_string(estimates.rows()) + " x " + std::to_string(estimates.cols()),
           std::to_string(s.N()) + " x " + std::to_string(s.n()) + ", one row per agent");
  return s.W * (estimates * s.A.transpose());
}

CovarianceBound covariance_bound(const Setting& s, const GainMatrices& K, bool printed) {
  require_valid(s);
  const ErrorDynamics d = error_dynamics(s, K);
  const Index n = s.n();
  const Index N = s.N();
  CovarianceBound c{};
  double reduction = 0.0;
  double gain = 0.0;
  for (Index i = 0; i < N; ++i) {
    reduction = std::max(reduction, norm2(d.reduction.block(i * n, i * n, n, n)));
    gain = std::max(gain, norm2(K[static_cast<std::size_t>(i)]));
  }
  c.a1 = reduction * reduction;
  c.a2 = gain * gain;
  c.b = norm2(d.Ahat);
  if (printed) {
    for (Index i = 0; i < N; ++i) {
      Matrix sum = Matrix::Zero(n, n);
      for (Index j = 0; j < N; ++j)
        if (s.U(i, j) != 0.0) sum += s.R(j, j) * s.C.row(j).transpose() * s.C.row(j);
      c.Rbar_norm = std::max(c.Rbar_norm, norm2(sum));
    }
  } else {
    Matrix Db = Matrix::Zero(N * n, N);
    for (Index i = 0; i < N; ++i)
      for (Index j = 0; j < N; ++j)
        if (s.U(i, j) != 0.0) Db.block(i * n, j, n, 1) = s.C.row(j).transpose();
    // |Db R Db'| = largest eigenvalue of R^(1/2) Db'Db R^(1/2) = that of Db'Db R.
    const double norm = norm2(Db * garrison::detail::covariance_root(s.R));
    c.Rbar_norm = norm * norm;
  }
  const auto agents = static_cast<double>(N);
  c.bound = c.b < 1.0 ? (c.a1 * agents * norm2(s.E) + c.a2 * c.Rbar_norm) / (1.0 - c.b * c.b) : kInfinity;
  c.Q1 = c.bound / agents;
  return c;
}

}  // namespace garrison::structural
