// SPDX-License-Identifier: Apache-2.0
// Choice of a design, and the spectral radius of large networks.
#include "garrison/filters/structural/gains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks.hpp"
#include "core/solvers.hpp"
#include "garrison/analysis/modes.hpp"
#include "garrison/core/params.hpp"
#include "garrison/core/spectrum.hpp"
#include "garrison/filters/structural/errors.hpp"

namespace garrison::structural {
namespace {

using Index = Eigen::Index;

constexpr Index kDense = 400;  // N n up to which eigenvalues are taken from the whole matrix

/// Distance of a spectral radius from 1 that may be rounding.
double rounding_of_radius(const Setting& s) {
  return 4.0 * std::numeric_limits<double>::epsilon() * static_cast<double>(s.N() * s.n());
}

/// Refuses modes on the unit circle that no process noise drives. Their error in the steady state is 0, and
/// with it the gain: an estimate that starts off there stays off, and no recursion tells, as P falls like
/// 1/t.
void require_driven(const Setting& s) {
  constexpr double kCircle = 1e-9;
  const Eigen::LLT<Matrix> llt(s.E);
  if (s.E.size() == 0 || llt.info() == Eigen::Success) return;
  for (const auto& mode : unseen_modes(s.A.transpose(), s.E, 1.0 - kCircle))
    if (std::abs(mode) <= 1.0 + kCircle)
      throw DesignInfeasible(
          "process_covariance drives no part of the mode " + text(mode.real()) +
          (mode.imag() != 0.0 ? (mode.imag() < 0.0 ? " - " : " + ") + text(std::abs(mode.imag())) + "i"
                              : "") +
          ", which does not decay: its best steady gain is 0, so that a wrong start is never corrected; give "
          "the states it moves some process noise, however small");
}

[[noreturn]] void refuse_unsettled(int sweeps, const std::string& method) {
  throw DesignInfeasible("the coupled Riccati recursion still changes after " + std::to_string(sweeps) +
                         " sweeps: its gains would not be the best ones; raise process_covariance (a mode "
                         "that neither decays nor "
                         "is driven by noise has no best gain)" +
                         (method == "riccati" ? ", or try the design 'h2'" : ""));
}

}  // namespace

double error_radius(const Setting& s, const GainMatrices& K) {
  require_graphs(s);
  require_gains(s, K);
  const Index n = s.n();
  const Index N = s.N();
  if (N * n <= kDense) return spectral_radius(error_dynamics(s, K).Ahat);
  std::vector<Matrix> reduced;
  for (Index i = 0; i < N; ++i)
    reduced.push_back((Matrix::Identity(n, n) - K[static_cast<std::size_t>(i)] * detail::seen(s, i)) * s.A);
  const auto apply = [&](const Vector& v) {
    const Eigen::Map<const Matrix> blocks(v.data(), n, N);
    const Matrix mixed = blocks * s.W.transpose();
    Vector out(v.size());
    for (Index i = 0; i < N; ++i) out.segment(i * n, n) = reduced[static_cast<std::size_t>(i)] * mixed.col(i);
    return out;
  };
  // Arnoldi, restarted with the last vector of the basis; the largest Ritz value rises towards rho.
  constexpr Index kBasis = 60;
  Vector v = Vector::LinSpaced(N * n, 1.0, 2.0);
  for (Index k = 1; k < v.size(); k += 2) v(k) = -v(k);
  double rho = 0.0;
  for (int restart = 0; restart < 40; ++restart) {
    Matrix V(N * n, kBasis + 1);
    Matrix H = Matrix::Zero(kBasis + 1, kBasis);
    V.col(0) = v.normalized();
    Index m = 0;
    for (; m < kBasis; ++m) {
      Vector w = apply(V.col(m));
      for (int twice = 0; twice < 2; ++twice) {
        const Vector h = V.leftCols(m + 1).transpose() * w;
        w -= V.leftCols(m + 1) * h;
        H.col(m).head(m + 1) += h;
      }
      H(m + 1, m) = w.norm();
      if (!(H(m + 1, m) > 1e-14 * H.cwiseAbs().maxCoeff())) {
        ++m;
        break;
      }
      V.col(m + 1) = w / H(m + 1, m);
    }
    const Eigen::EigenSolver<Matrix> ritz(H.topLeftCorner(m, m));
    Index best = 0;
    const double now = ritz.eigenvalues().cwiseAbs().maxCoeff(&best);
    const Eigen::VectorXcd vector = ritz.eigenvectors().col(best);
    const double left = m < kBasis ? 0.0 : H(m, m - 1) * std::abs(vector(m - 1));
    rho = std::max(rho, now);
    if (left <= 1e-8 * std::max(now, 1e-300)) return rho;
    v = V.leftCols(m) * (vector.real() + vector.imag());
  }
  return rho;
}

std::string detail::advice(const Setting& s, const std::string& otherwise) {
  constexpr double kFar = 1e12;  // of variances
  if (s.E.size() == 0) return otherwise;
  const Vector variance = s.E.diagonal();
  const double most = variance.maxCoeff();
  double least = most;
  for (const double one : variance)
    if (one > 0.0) least = std::min(least, one);
  if (!(most > kFar * least)) return otherwise;
  return "the states have process noise from " + text(std::sqrt(least)) + " to " + text(std::sqrt(most)) +
         ": bring them to comparable units";
}

Designed design_gains(const Setting& s, const std::string& method) {
  const std::vector<std::string> known{"auto", "riccati", "kalman", "h2", "projection"};
  if (std::find(known.begin(), known.end(), method) == known.end())
    refuse_unknown("gain design", method, known);
  if (method != "projection") require_driven(s);
  const bool any = method == "auto";
  double reached = kInfinity;
  Designed d;
  const auto accept = [&](GainMatrices K, const char* name) {
    for (const Matrix& one : K)
      if (!one.allFinite()) return false;  // the recursion diverged
    d.rho = error_radius(s, K);
    reached = std::min(reached, d.rho);
    d.K = std::move(K);
    d.method = name;
    return d.rho < 1.0 - rounding_of_radius(s);
  };
  int unsettled = 0;  // sweeps after which the recursion still changed
  if (any || method == "riccati" || method == "h2") {
    auto g = coupled_riccati(s, 20000, 1e-11);
    const bool schur = accept(g.K, "riccati");
    // A recursion that grows for ever has gains of its own; one that still changes has no answer yet.
    if (schur && method != "h2" && (g.converged || g.diverged)) {
      if (g.converged) d.P = std::move(g.P);
      return d;
    }
    if (!g.converged && !g.diverged) unsettled = g.sweeps;
    if (schur && method == "riccati") refuse_unsettled(g.sweeps, method);
  }
  if (any || method == "kalman" || (method == "h2" && unsettled > 0)) {
    const auto g = joint_kalman(s);
    const bool schur = accept(g.K, "kalman");
    if (schur && method != "h2" && (g.converged || (any && unsettled == 0))) return d;
    if (!g.converged && unsettled > 0) refuse_unsettled(unsettled, method);
  }
  if (method == "projection" && accept(projection_gains(s), "projection")) return d;
  if (any || method == "h2") {
    accept(h2_gains(s, std::isfinite(d.rho) ? d.K : projection_gains(s)), "h2");
    return d;
  }
  throw DesignInfeasible("no stabilising gain by the design '" + method +
                         "': spectral radius reached: " + text(reached) + ", needed below 1; " +
                         detail::advice(s, "try the design 'h2', or smaller self-weights W_ii"));
}

ScalarGainChoice best_scalar_gain(double a, const MatrixRef& W) {
  if (!std::isfinite(a)) refuse("a", text(a), "a finite number");
  if (W.rows() != W.cols() || W.rows() < 1 || !W.allFinite())
    refuse(
        "W",
        std::to_string(W.rows()) + " x " + std::to_string(W.cols()) + (W.allFinite() ? "" : ", not finite"),
        "a square matrix of finite numbers with at least one row");
  const auto radius = [&](double k) {
    Matrix M = W;
    M.row(0) *= 1.0 - k;
    return std::abs(a) * spectral_radius(M);
  };
  // k = 1 removes agent 0's own past; in [0, 1] nothing beats it (Perron). Beyond it is searched.
  ScalarGainChoice best{1.0, radius(1.0)};
  constexpr int kGrid = 400;
  for (int g = 1; g <= kGrid; ++g) {
    const double width = 2.0 / kGrid;
    double lo = 1.0 + (g - 1) * width;
    double hi = lo + 2.0 * width;
    for (int k = 0; k < 60; ++k) {
      const double a1 = lo + 0.381966 * (hi - lo);
      const double a2 = lo + 0.618034 * (hi - lo);
      (radius(a1) < radius(a2) ? hi : lo) = radius(a1) < radius(a2) ? a2 : a1;
      if (radius(lo) > best.radius + 0.1 && radius(hi) > best.radius + 0.1) break;
    }
    const double k = 0.5 * (lo + hi);
    if (radius(k) < best.radius * (1.0 - 1e-9)) best = {k, radius(k)};
  }
  return best;
}

}  // namespace garrison::structural
