// SPDX-License-Identifier: Apache-2.0
// tr Q minimised over block-diagonal gains: L-BFGS with adjoint gradients, discount homotopy, (18) as
// penalty.
#include <algorithm>
#include <cmath>
#include <deque>

#include "blocks.hpp"
#include "garrison/core/budget.hpp"
#include "garrison/core/spectrum.hpp"
#include "garrison/filters/structural/errors.hpp"
#include "garrison/filters/structural/gains.hpp"

namespace garrison::structural {
namespace {

using Index = Eigen::Index;

/// X = M X M' + F by doubling; false when M is not Schur.
bool steady(const Matrix& M, const Matrix& F, Matrix& X) {
  Matrix power = M;
  X = F;
  for (int k = 0; k < 40; ++k) {
    const Matrix more = power * X * power.transpose();
    X += more;
    const double size = X.cwiseAbs().maxCoeff();
    if (!(size < 1e60)) return false;
    if (more.cwiseAbs().maxCoeff() <= 1e-16 * size) return true;
    power = power * power;
  }
  return false;
}

/// Cost and gradient in the free numbers M_i of K_i = M_i B_i'.
class Cost {
 public:
  Cost(const Setting& s, std::span<const int> hubs, double epsilon)
      : s_(s), hubs_(hubs.begin(), hubs.end()), epsilon_(epsilon) {
    const Index n = s.n();
    const Index N = s.N();
    for (Index i = 0; i < N; ++i) {
      views_.push_back(detail::view(s, i));
      D_.push_back(detail::seen(s, i));
      size_ += n * views_.back().basis.cols();
    }
    Db_ = Matrix::Zero(N * n, N);
    mix_.resize(N * n, N * n);
    common_.resize(N * n, N * n);
    for (Index i = 0; i < N; ++i)
      for (Index j = 0; j < N; ++j) {
        if (s.U(i, j) != 0.0) Db_.block(i * n, j, n, 1) = s.C.row(j).transpose();
        mix_.block(i * n, j * n, n, n) = s.W(i, j) * s.A;
        common_.block(i * n, j * n, n, n) = s.E;
      }
    noise_ = Db_ * s.R * Db_.transpose();
  }

  Index size() const { return size_; }
  double scale = 1.0;    ///< of A: below 1 while discounting
  double penalty = 0.0;  ///< weight of the violation of (18)

  GainMatrices gains(const Vector& x) const {
    GainMatrices K;
    Index at = 0;
    for (const auto& v : views_) {
      const Index d = v.basis.cols();
      K.push_back(Eigen::Map<const Matrix>(x.data() + at, s_.n(), d) * v.basis.transpose());
      at += s_.n() * d;
    }
    return K;
  }
  Vector numbers(const GainMatrices& K) const {
    Vector x(size_);
    Index at = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const Matrix M = K[i] * views_[i].basis;
      std::copy_n(M.data(), M.size(), x.data() + at);
      at += M.size();
    }
    return x;
  }

  /// tr Q plus penalty; infinite outside of the Schur gains.
  double operator()(const Vector& x, Vector& gradient) const {
    const Index n = s_.n();
    const Index N = s_.N();
    const GainMatrices K = gains(x);
    Matrix reduction = Matrix::Identity(N * n, N * n);
    Matrix Kb = Matrix::Zero(N * n, N * n);
    Matrix D = Matrix::Zero(N * n, N * n);
    for (Index i = 0; i < N; ++i) {
      const auto k = static_cast<std::size_t>(i);
      reduction.block(i * n, i * n, n, n) -= K[k] * D_[k];
      Kb.block(i * n, i * n, n, n) = K[k];
      D.block(i * n, i * n, n, n) = D_[k];
    }
    const Matrix mix = scale * mix_;
    const Matrix Ahat = reduction * mix;
    Matrix Q;
    if (!steady(Ahat, reduction * common_ * reduction.transpose() + Kb * noise_ * Kb.transpose(), Q))
      return kInfinity;
    Matrix X;
    if (!steady(Ahat.transpose(), Matrix::Identity(N * n, N * n), X)) return kInfinity;
    // d tr Q / d K = 2 X (K (D P D' + Rb) - P D'), P the joint prior covariance.
    const Matrix P = mix * Q * mix.transpose() + common_;
    const Matrix slope = 2.0 * X * (Kb * (D * P * D + noise_) - P * D);
    std::vector<Matrix> G;
    for (Index i = 0; i < N; ++i) G.push_back(slope.block(i * n, i * n, n, n));
    double cost = Q.trace() + (penalty > 0.0 ? isolation(K, G) : 0.0);
    gradient.resize(size_);
    Index at = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const Matrix own = G[i] * views_[i].basis;
      std::copy_n(own.data(), own.size(), gradient.data() + at);
      at += own.size();
    }
    return cost;
  }

 private:
  /// penalty * sum of max(0, |c_i'K_i c_j| - eps |1 - c_j'K_j c_j|)^2, and its gradient added to G.
  double isolation(const GainMatrices& K, std::vector<Matrix>& G) const {
    double sum = 0.0;
    for (const int j : hubs_) {
      const auto kj = static_cast<std::size_t>(j);
      const Vector cj = s_.C.row(j);
      const double own = 1.0 - cj.dot(K[kj] * cj);
      for (Index i = 0; i < s_.N(); ++i) {
        if (i == j) continue;
        const auto ki = static_cast<std::size_t>(i);
        const Vector ci = s_.C.row(i);
        const double reaction = ci.dot(K[ki] * cj);
        const double excess = std::abs(reaction) - epsilon_ * std::abs(own);
        if (excess <= 0.0) continue;
        sum += excess * excess;
        const double weight = 2.0 * penalty * excess;
        G[ki] += weight * (reaction < 0.0 ? -1.0 : 1.0) * ci * cj.transpose();
        G[kj] += weight * epsilon_ * (own < 0.0 ? -1.0 : 1.0) * cj * cj.transpose();
      }
    }
    return penalty * sum;
  }

  const Setting& s_;
  std::vector<int> hubs_;
  double epsilon_;
  std::vector<detail::View> views_;
  std::vector<Matrix> D_;
  Matrix Db_, mix_, common_, noise_;
  Index size_ = 0;
};

/// L-BFGS with backtracking (Nocedal, Wright, algorithm 7.4); leaves x at the best point found.
void minimise(const Cost& cost, Vector& x, int most, double tolerance) {
  constexpr std::size_t kMemory = 30;
  Vector g;
  double f = cost(x, g);
  std::deque<Vector> steps;
  std::deque<Vector> turns;
  int idle = 0;
  for (int it = 0; it < most && std::isfinite(f) && idle < 5; ++it) {
    require_time("the h2 design");
    Vector p = -g;
    std::vector<double> alpha(steps.size());
    for (std::size_t k = steps.size(); k-- > 0;) {
      alpha[k] = steps[k].dot(p) / steps[k].dot(turns[k]);
      p -= alpha[k] * turns[k];
    }
    if (!steps.empty()) p *= steps.back().dot(turns.back()) / turns.back().squaredNorm();
    for (std::size_t k = 0; k < steps.size(); ++k)
      p += (alpha[k] - turns[k].dot(p) / steps[k].dot(turns[k])) * steps[k];
    double slope = p.dot(g);
    if (!(slope < 0.0)) {
      steps.clear();
      turns.clear();
      p = -g;
      slope = -g.squaredNorm();
    }
    if (slope == 0.0) break;
    double t = steps.empty() ? std::min(1.0, 0.1 * (1.0 + x.norm()) / p.norm()) : 1.0;
    Vector next;
    Vector g_next;
    double f_next = kInfinity;
    for (int k = 0; k < 50; ++k, t *= 0.5) {
      next = x + t * p;
      f_next = cost(next, g_next);
      if (f_next <= f + 1e-4 * t * slope) break;
    }
    if (!(f_next < f)) {
      if (steps.empty()) break;
      steps.clear();
      turns.clear();
      ++idle;
      continue;
    }
    const Vector step = next - x;
    const Vector turn = g_next - g;
    if (step.dot(turn) > 1e-12 * step.norm() * turn.norm()) {
      steps.push_back(step);
      turns.push_back(turn);
      if (steps.size() > kMemory) {
        steps.pop_front();
        turns.pop_front();
      }
    }
    idle = f - f_next <= tolerance * f ? idle + 1 : 0;
    x = next;
    g = g_next;
    f = f_next;
  }
}

double largest_ratio(const Setting& s, const GainMatrices& K, std::span<const int> hubs) {
  const Matrix ratio = isolation_ratios(s, K);
  double largest = 0.0;
  for (const int j : hubs) largest = std::max(largest, ratio.col(j).maxCoeff());
  return largest;
}

}  // namespace

GainMatrices h2_gains(const Setting& s, const GainMatrices& start, std::span<const int> hubs,
                      double epsilon) {
  require_valid(s);
  require_gains(s, start);
  if (!(epsilon >= 0.0 && epsilon < 1.0)) refuse("epsilon", text(epsilon), "a number in [0, 1)");
  for (const int j : hubs)
    if (j < 0 || j >= s.N()) refuse("hubs", std::to_string(j), "agents in 0.." + std::to_string(s.N() - 1));
  // The penalty leaves a small violation: it is aimed a little below the number asked for.
  Cost cost(s, hubs, epsilon);
  Vector x = cost.numbers(start);
  double rho = spectral_radius(error_dynamics(s, cost.gains(x)).Ahat);
  double gamma = rho < 1.0 ? 1.0 : 0.95 / rho;
  for (int k = 0; k < 200 && gamma < 1.0; ++k) {
    cost.scale = gamma;
    minimise(cost, x, 60, 1e-6);
    rho = spectral_radius(error_dynamics(s, cost.gains(x)).Ahat);
    if (rho < 1.0) break;
    const double more = 0.9 * (1.0 / rho - gamma);
    if (more < 1e-5 * gamma) break;
    gamma += more;
  }
  if (!(rho < 1.0))
    throw DesignInfeasible("no stabilising gain was found: spectral radius reached: " + text(rho) +
                           ", needed below 1; " + detail::advice(s, "smaller self-weights W_ii may help"));
  cost.scale = 1.0;
  minimise(cost, x, 3000, 1e-12);
  if (hubs.empty()) return cost.gains(x);
  Vector gradient;
  cost.penalty = std::max(1.0, cost(x, gradient));
  for (int k = 0; k < 14; ++k) {
    minimise(cost, x, 400, 1e-11);
    if (largest_ratio(s, cost.gains(x), hubs) <= epsilon * (1.0 + 1e-4)) break;
    cost.penalty *= 10.0;
  }
  return cost.gains(x);
}

}  // namespace garrison::structural
