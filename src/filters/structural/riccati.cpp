// SPDX-License-Identifier: Apache-2.0
// Coupled Riccati recursion, joint Kalman recursion, projection.
#include <cmath>

#include "blocks.hpp"
#include "core/solvers.hpp"
#include "garrison/filters/structural/gains.hpp"

namespace garrison::structural {

using Index = Eigen::Index;

Matrix detail::pseudo_inverse(const Matrix& S) {
  const Index d = S.rows();
  if (d == 0) return S;
  if (d == 1) return Matrix::Constant(1, 1, S(0, 0) > 0.0 ? 1.0 / S(0, 0) : 0.0);
  const Eigen::LLT<Matrix> llt(S);
  if (llt.info() == Eigen::Success) {
    const auto diagonal = llt.matrixLLT().diagonal();
    if (diagonal.minCoeff() > 1e-5 * diagonal.maxCoeff()) return llt.solve(Matrix::Identity(d, d));
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(0.5 * (S + S.transpose()));
  const Vector values = eigen.eigenvalues();
  const double cut = 1e-13 * values.cwiseAbs().maxCoeff();
  Vector inverse(d);
  for (Index k = 0; k < d; ++k) inverse(k) = values(k) > cut ? 1.0 / values(k) : 0.0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

namespace {

struct Link {
  std::size_t agent;
  double weight;
};

std::vector<std::vector<Link>> mixing_links(const Matrix& W) {
  std::vector<std::vector<Link>> links(static_cast<std::size_t>(W.rows()));
  for (Index i = 0; i < W.rows(); ++i)
    for (Index j = 0; j < W.cols(); ++j)
      if (W(i, j) != 0.0)
        links[static_cast<std::size_t>(i)].push_back({static_cast<std::size_t>(j), W(i, j)});
  return links;
}

std::vector<detail::View> views(const Setting& s) {
  std::vector<detail::View> all;
  for (Index i = 0; i < s.N(); ++i) all.push_back(detail::view(s, i));
  return all;
}

}  // namespace

RiccatiGains coupled_riccati(const Setting& s, int most_sweeps, double tolerance) {
  require_valid(s);
  const Index n = s.n();
  const auto N = static_cast<std::size_t>(s.N());
  const auto links = mixing_links(s.W);
  const auto view = views(s);
  RiccatiGains g;
  g.P.assign(N, s.E + 1e-12 * Matrix::Identity(n, n));
  g.Pprior = g.P;
  std::vector<Matrix> gain(N);
  std::vector<Matrix> next = g.P;
  Matrix mixed(n, n);
  Matrix half(n, n);
  Matrix PH;
  Matrix S;
  Matrix HP;
  for (g.sweeps = 1; g.sweeps <= most_sweeps; ++g.sweeps) {
    double change = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      mixed.setZero();
      for (const Link& l : links[i]) mixed += l.weight * g.P[l.agent];
      half.noalias() = s.A * mixed;
      Matrix& prior = g.Pprior[i];
      prior = s.E;
      prior.noalias() += half * s.A.transpose();
      const detail::View& v = view[i];
      PH.noalias() = prior * v.H.transpose();
      S = v.noise;
      S.noalias() += v.H * PH;
      gain[i].noalias() = PH * detail::pseudo_inverse(S);
      HP = PH.transpose();
      next[i] = prior;
      next[i].noalias() -= gain[i] * HP;
      half = next[i].transpose();
      next[i] = 0.5 * (next[i] + half);
      change = std::max(change, (next[i] - g.P[i]).cwiseAbs().maxCoeff());
      size = std::max(size, next[i].cwiseAbs().maxCoeff());
    }
    std::swap(g.P, next);
    if (!(size < 1e100) || !(change < 1e100)) break;
    if (change <= tolerance * size) {
      g.converged = true;
      break;
    }
  }
  for (std::size_t i = 0; i < N; ++i) g.K.push_back(gain[i] * view[i].basis.transpose());
  return g;
}

JointGains joint_kalman(const Setting& s, int most_sweeps, double tolerance) {
  require_valid(s);
  const Index n = s.n();
  const Index N = s.N();
  const auto view = views(s);
  Matrix mix(N * n, N * n);
  for (Index i = 0; i < N; ++i)
    for (Index j = 0; j < N; ++j) mix.block(i * n, j * n, n, n) = s.W(i, j) * s.A;
  JointGains g;
  g.K.assign(static_cast<std::size_t>(N), Matrix::Zero(n, n));
  Matrix Q = Matrix::Identity(N * n, N * n);
  Matrix reduction = Matrix::Identity(N * n, N * n);
  Matrix injection = Matrix::Zero(N * n, N);
  for (g.sweeps = 1; g.sweeps <= most_sweeps; ++g.sweeps) {
    Matrix P = mix * Q * mix.transpose();
    for (Index i = 0; i < N; ++i)
      for (Index j = 0; j < N; ++j) P.block(i * n, j * n, n, n) += s.E;
    double change = 0.0;
    double size = 0.0;
    for (Index i = 0; i < N; ++i) {
      const detail::View& v = view[static_cast<std::size_t>(i)];
      const Matrix K = detail::best_gain(v, P.block(i * n, i * n, n, n)) * v.basis.transpose();
      Matrix& old = g.K[static_cast<std::size_t>(i)];
      change = std::max(change, (K - old).cwiseAbs().maxCoeff());
      size = std::max(size, K.cwiseAbs().maxCoeff());
      old = K;
      reduction.block(i * n, i * n, n, n) = Matrix::Identity(n, n) - K * detail::seen(s, i);
      for (Index j = 0; j < N; ++j)
        if (s.U(i, j) != 0.0) injection.block(i * n, j, n, 1) = K * s.C.row(j).transpose();
    }
    Q = reduction * P * reduction.transpose() + injection * s.R * injection.transpose();
    Q = 0.5 * (Q + Q.transpose()).eval();
    if (!(Q.cwiseAbs().maxCoeff() < 1e100)) break;
    if (change <= tolerance * std::max(size, 1.0)) {
      g.converged = true;
      break;
    }
  }
  return g;
}

GainMatrices projection_gains(const Setting& s) {
  require_graphs(s);
  const Matrix S = s.A * s.A.transpose();
  GainMatrices K;
  for (Index i = 0; i < s.N(); ++i) {
    detail::View v = detail::view(s, i);
    v.noise.setZero();
    K.push_back(detail::best_gain(v, S) * v.basis.transpose());
  }
  return K;
}

}  // namespace garrison::structural
