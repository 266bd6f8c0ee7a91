// SPDX-License-Identifier: Apache-2.0
// Coupled Riccati recursion, joint Kalman recursion, projection.
#include <cmath>

#include "analysis/extended.hpp"
#include "analysis/policy_iteration.hpp"
#include "blocks.hpp"
#include "core/solvers.hpp"
#include "garrison/analysis/lyapunov.hpp"
#include "garrison/core/budget.hpp"
#include "garrison/filters/structural/errors.hpp"
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
  const Matrix symmetric = 0.5 * (S + S.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(symmetric);
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

/// Sweeps after which a recursion that still changes is left to Newton's method.
constexpr int kQuickSweeps = 400;

/// One recursion of n x n per agent, P_i <- (I - K_i D_i) (A (sum_j W_ij P_j) A' + E) (...)' + K_i Rz_i K_i'.
class Coupled {
 public:
  explicit Coupled(const Setting& s)
      : s_(s), links_(mixing_links(s.W)), views_(views(s)), gain_(views_.size()) {}

  const detail::View& view(std::size_t i) const { return views_[i]; }
  const Matrix& gain(std::size_t i) const { return gain_[i]; }

  template <class M>
  M mixed(std::size_t i, const std::vector<Matrix>& P) const {
    M sum = M::Zero(s_.n(), s_.n());
    for (const Link& l : links_[i])
      sum += static_cast<typename M::Scalar>(l.weight) * P[l.agent].template cast<typename M::Scalar>();
    return sum;
  }

  /// P after the measurement; the gain is kept, the prior is written.
  Matrix update(std::size_t i, const std::vector<Matrix>& P, Matrix& prior) {
    prior = s_.E + s_.A * mixed<Matrix>(i, P) * s_.A.transpose();
    const Matrix PH = prior * views_[i].H.transpose();
    gain_[i] = PH * detail::pseudo_inverse(views_[i].noise + views_[i].H * PH);
    const Matrix next = prior - gain_[i] * PH.transpose();
    return 0.5 * (next + next.transpose());
  }

  /// Sweeps from g.P until the change is below `tolerance` and not merely slow; false when it grows or still
  /// changes after `most`.
  bool settle(RiccatiGains& g, double tolerance, int most) {
    constexpr double kSlow = 0.9;        // ratio of successive changes: what is left is 10 times the last one
    constexpr double kRounding = 4e-16;  // below, the ratio says nothing
    std::vector<Matrix> next = g.P;
    double before = 0.0;
    for (int k = 0; k < most; ++k) {
      ++g.sweeps;
      require_time("the coupled Riccati recursion");
      double change = 0.0;
      double size = 0.0;
      for (std::size_t i = 0; i < next.size(); ++i) {
        next[i] = update(i, g.P, g.Pprior[i]);
        change = std::max(change, (next[i] - g.P[i]).cwiseAbs().maxCoeff());
        size = std::max(size, next[i].cwiseAbs().maxCoeff());
      }
      std::swap(g.P, next);
      g.diverged = !(size < 1e100) || !(change < 1e100);
      if (g.diverged) return false;
      const bool slow = change > kSlow * before && change > kRounding * size;
      before = change;
      if (change <= tolerance * size && !slow) return true;
    }
    return false;
  }

  /// Whether the variance of no state still changes, in its own size: a small one that grows by as much as
  /// all the noise that drives it is not seen beside large ones.
  bool rests(const RiccatiGains& g) {
    constexpr double kChange = 1e-6;
    constexpr double kRounding = 1e-15;  // of the largest
    Matrix prior;
    for (std::size_t i = 0; i < g.P.size(); ++i) {
      const Vector now = g.P[i].diagonal();
      const Vector change = update(i, g.P, prior).diagonal() - now;
      if ((change.cwiseAbs().array() > kChange * now.array() + kRounding * now.maxCoeff()).any())
        return false;
    }
    return true;
  }

 private:
  const Setting& s_;
  std::vector<std::vector<Link>> links_;
  std::vector<detail::View> views_;
  std::vector<Matrix> gain_;  // on the basis of the view
};

/// The recursion for Newton's method: its policies are the gains.
class CoupledMap : public garrison::detail::RiccatiMap {
 public:
  CoupledMap(const Setting& s, Coupled& coupled)
      : s_(s), coupled_(coupled), closed_(static_cast<std::size_t>(s.N())) {}

  std::vector<Matrix> residual(const std::vector<Matrix>& P) override {
    using garrison::detail::congruence, garrison::detail::Extended, garrison::detail::extended,
        garrison::detail::product;
    const Extended A = extended(s_.A);
    std::vector<Matrix> r;
    Matrix prior;
    for (std::size_t i = 0; i < P.size(); ++i) {
      coupled_.update(i, P, prior);
      // An error of the gain counts by its square only; the rest needs the digits.
      const Extended K = extended(coupled_.gain(i));
      const Extended keep = Extended::Identity(s_.n(), s_.n()) - product(K, extended(coupled_.view(i).H));
      const Extended exact = extended(s_.E) + congruence(A, coupled_.mixed<Extended>(i, P));
      const Extended next = congruence(keep, exact) + congruence(K, extended(coupled_.view(i).noise));
      r.push_back((next - extended(P[i])).cast<double>());
      closed_[i] = keep.cast<double>() * s_.A;
    }
    return r;
  }
  std::vector<Matrix> apply(const std::vector<Matrix>& D) const override {
    std::vector<Matrix> all;
    for (std::size_t i = 0; i < D.size(); ++i)
      all.push_back(closed_[i] * coupled_.mixed<Matrix>(i, D) * closed_[i].transpose());
    return all;
  }

 private:
  const Setting& s_;
  Coupled& coupled_;
  std::vector<Matrix> closed_;  // (I - K_i D_i) A
};

/// Newton's method from the solution for more process noise: that one is an upper bound, and with enough of
/// it the sweeps settle quickly.
bool newton(const Setting& s, Coupled& coupled, RiccatiGains& g) {
  if (s.E.isZero(0.0)) return false;  // more of nothing is nothing
  Setting noisy = s;
  for (double more = 1e2; more < 1e40; more *= 1e2) {
    noisy.E = more * s.E;
    Coupled rough(noisy);
    RiccatiGains start;
    start.P.assign(g.P.size(), noisy.E);
    start.Pprior = start.P;
    const bool settled = rough.settle(start, 1e-6, kQuickSweeps);
    g.sweeps += start.sweeps;
    if (start.diverged) return false;
    if (!settled) continue;
    for (Matrix& P : start.P) P *= 1.01;
    CoupledMap map(s, coupled);
    auto found = garrison::detail::policy_iteration(map, std::move(start.P));
    g.sweeps += found.steps;
    if (!found.converged) continue;
    g.P = std::move(found.P);
    return true;
  }
  return false;
}

}  // namespace

RiccatiGains coupled_riccati(const Setting& s, int most_sweeps, double tolerance) {
  require_valid(s);
  const auto N = static_cast<std::size_t>(s.N());
  Coupled coupled(s);
  RiccatiGains g;
  g.P.assign(N, s.E + 1e-12 * Matrix::Identity(s.n(), s.n()));
  g.Pprior = g.P;
  g.converged = coupled.settle(g, tolerance, std::min(most_sweeps, kQuickSweeps)) && coupled.rests(g);
  if (!g.converged && !g.diverged && most_sweeps > kQuickSweeps) {
    g.converged = newton(s, coupled, g);
    if (g.converged)
      for (std::size_t i = 0; i < N; ++i) coupled.update(i, g.P, g.Pprior[i]);
    else
      g.converged = coupled.settle(g, tolerance, most_sweeps - g.sweeps) && coupled.rests(g);
  }
  for (std::size_t i = 0; i < N; ++i) g.K.push_back(coupled.gain(i) * coupled.view(i).basis.transpose());
  return g;
}

namespace {

/// The joint covariance of all errors, with each agent's gain taken from its own block.
class Joint {
 public:
  explicit Joint(const Setting& s) : s_(s), views_(views(s)) {
    const Index n = s.n();
    const Index N = s.N();
    mix_.resize(N * n, N * n);
    for (Index i = 0; i < N; ++i)
      for (Index j = 0; j < N; ++j) mix_.block(i * n, j * n, n, n) = s.W(i, j) * s.A;
    reduction_ = Matrix::Identity(N * n, N * n);
    injection_ = Matrix::Zero(N * n, N);
  }

  Matrix prior(const Matrix& Q) const {
    const Index n = s_.n();
    Matrix P = mix_ * Q * mix_.transpose();
    for (Index i = 0; i < s_.N(); ++i)
      for (Index j = 0; j < s_.N(); ++j) P.block(i * n, j * n, n, n) += s_.E;
    return P;
  }

  /// The best gains at this prior; returns their largest change, relative to the largest gain (absolute below
  /// 1 when `lax`).
  double take_gains(const Matrix& P, GainMatrices& gains, bool lax) {
    const Index n = s_.n();
    double change = 0.0;
    double size = 0.0;
    for (Index i = 0; i < s_.N(); ++i) {
      const detail::View& v = views_[static_cast<std::size_t>(i)];
      const Matrix K = detail::best_gain(v, P.block(i * n, i * n, n, n)) * v.basis.transpose();
      Matrix& old = gains[static_cast<std::size_t>(i)];
      change = std::max(change, (K - old).cwiseAbs().maxCoeff());
      size = std::max(size, K.cwiseAbs().maxCoeff());
      old = K;
      reduction_.block(i * n, i * n, n, n) = Matrix::Identity(n, n) - K * detail::seen(s_, i);
      for (Index j = 0; j < s_.N(); ++j)
        if (s_.U(i, j) != 0.0) injection_.block(i * n, j, n, 1) = K * s_.C.row(j).transpose();
    }
    size = lax ? std::max(size, 1.0) : size;
    return size > 0.0 ? change / size : 0.0;
  }

  Matrix noise() const { return injection_ * s_.R * injection_.transpose(); }
  Matrix update(const Matrix& P) const {
    const Matrix Q = reduction_ * P * reduction_.transpose() + noise();
    return 0.5 * (Q + Q.transpose());
  }
  /// The covariance that the gains taken last settle to. @throws InvalidInput when they are not Schur
  Matrix stationary() const {
    return lyapunov(reduction_ * mix_, update(prior(Matrix::Zero(mix_.rows(), mix_.cols()))));
  }

 private:
  const Setting& s_;
  std::vector<detail::View> views_;
  Matrix mix_, reduction_, injection_;
};

/// Gains that are best at the covariance that they themselves settle to, from gains close to them or not.
bool polish(Joint& joint, JointGains& g) {
  constexpr int kMost = 300;
  constexpr double kSame = 1e-9;
  const GainMatrices swept = g.K;
  try {
    for (int k = 0; k < kMost && !current_budget().over(); ++k) {
      const double change = joint.take_gains(joint.prior(joint.stationary()), g.K, false);
      if (k == 0 && change <= kSame) g.K = swept;  // the sweeps had settled
      if (change <= kSame) return true;
      ++g.sweeps;
    }
  } catch (const InvalidInput&) {  // not Schur: the gains of the sweeps are as good as any
    g.K = swept;
  }
  return false;
}

}  // namespace

JointGains joint_kalman(const Setting& s, int most_sweeps, double tolerance) {
  require_valid(s);
  const Index n = s.n();
  Joint joint(s);
  JointGains g;
  g.K.assign(static_cast<std::size_t>(s.N()), Matrix::Zero(n, n));
  Matrix Q = Matrix::Identity(s.N() * n, s.N() * n);
  for (g.sweeps = 1; g.sweeps <= std::min(most_sweeps, kQuickSweeps); ++g.sweeps) {
    require_time("the joint Kalman recursion");
    const Matrix P = joint.prior(Q);
    const bool settled = joint.take_gains(P, g.K, true) <= tolerance;
    Q = joint.update(P);
    if (!(Q.cwiseAbs().maxCoeff() < 1e100)) return g;
    if (settled) break;
  }
  g.converged = polish(joint, g);
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
