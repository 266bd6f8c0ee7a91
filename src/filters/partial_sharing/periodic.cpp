// SPDX-License-Identifier: Apache-2.0
// Over one cycle of selections the error dynamics are one matrix: its radius decides, and doubling solves.

#include "core/solvers.hpp"
#include "garrison/core/spectrum.hpp"
#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::partial_sharing {
namespace {

std::vector<Sparse> cycle(const Setting& s, const std::vector<LocalGains>& gains) {
  std::vector<Sparse> steps;
  for (int f = 0; f < s.selection.period(); ++f) steps.push_back(error_step(s, gains, f));
  return steps;
}

Matrix monodromy(const std::vector<Sparse>& steps) {
  Matrix product = Matrix(steps.front());
  for (std::size_t f = 1; f < steps.size(); ++f) product = steps[f] * product;
  return product;
}

double radius_of(const Matrix& product, int period) {
  if (!product.allFinite()) return kInfinity;
  return std::pow(spectral_radius(product), 1.0 / period);
}

void require_stable(const Setting& s, const Matrix& product) {
  const double radius = radius_of(product, s.selection.period());
  if (!(radius < 1.0))
    refuse("no steady state: cycle radius", text(radius), "a radius below 1",
           "the error dynamics with gamma = " + text(s.gamma) +
               " are unstable; lower gamma, or check detectability");
}

/// X = V + M X M' by doubling; rho(M) < 1.
Matrix lyapunov(Matrix M, Matrix V) {
  for (int k = 0; k < 64; ++k) {
    const Matrix half = M * V;
    Matrix more = half * M.transpose();
    more = (more + more.transpose()).eval() / 2.0;
    V += more;
    if (more.cwiseAbs().maxCoeff() <= 1e-18 * V.cwiseAbs().maxCoeff()) break;
    M = (M * M).eval();
  }
  return V;
}

Matrix symmetric(const Matrix& X) { return (X + X.transpose()) / 2.0; }

}  // namespace

double cycle_radius(const Setting& s, const std::vector<LocalGains>& gains) {
  return radius_of(monodromy(cycle(s, gains)), s.selection.period());
}

std::vector<Matrix> periodic_covariance(const Setting& s, const std::vector<LocalGains>& gains,
                                        const Matrix& Sigma) {
  const std::vector<Sparse> steps = cycle(s, gains);
  const Matrix product = monodromy(steps);
  require_stable(s, product);
  const Matrix noise = noise_covariance(s, gains);
  std::vector<Matrix> driven;  // what every phase adds
  for (std::size_t f = 0; f < steps.size(); ++f) {
    driven.push_back(noise);
    if (Sigma.size() == 0) continue;
    const Sparse Ga = attack_step(s, gains, static_cast<std::int64_t>(f));
    driven.back() += symmetric(Ga * Matrix(Ga * Sigma).transpose());
  }
  const auto advance_phase = [&](const Matrix& P, std::size_t f) {
    const Matrix half = steps[f] * P;
    return Matrix(symmetric(steps[f] * half.transpose()) + driven[f]);
  };
  Matrix V = Matrix::Zero(s.size(), s.size());
  for (std::size_t f = 0; f < steps.size(); ++f) V = advance_phase(V, f);
  std::vector<Matrix> phases{lyapunov(product, V)};
  for (std::size_t f = 0; f + 1 < steps.size(); ++f) phases.push_back(advance_phase(phases.back(), f));
  return phases;
}

std::vector<Matrix> periodic_adjoint(const Setting& s, const std::vector<LocalGains>& gains) {
  std::vector<Sparse> steps = cycle(s, gains);
  const Matrix product = monodromy(steps);
  require_stable(s, product);
  const Matrix I = Matrix::Identity(s.size(), s.size());
  const auto back = [&](const Matrix& W, std::size_t f) {
    const Sparse transposed = steps[f].transpose();
    const Matrix half = transposed * W;
    return Matrix(symmetric(transposed * half.transpose()) + I);
  };
  Matrix V = Matrix::Zero(s.size(), s.size());
  for (std::size_t f = steps.size(); f-- > 0;) V = back(V, f);
  std::vector<Matrix> phases(steps.size());
  phases[0] = lyapunov(product.transpose(), V);
  for (std::size_t f = steps.size(); f-- > 1;)
    phases[f] = back(f + 1 == steps.size() ? phases[0] : phases[f + 1], f);
  return phases;
}

}  // namespace garrison::partial_sharing
