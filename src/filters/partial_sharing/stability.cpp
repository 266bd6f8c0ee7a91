// SPDX-License-Identifier: Apache-2.0
#include "core/solvers.hpp"
#include "core/spectrum.hpp"
#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::partial_sharing {
namespace {

constexpr double kMostGamma = 1e6;
constexpr double kSlack = 1e-12;

/// Rows of H with unit noise.
Matrix white_rows(const Setting& s, int agent) {
  const auto i = static_cast<std::size_t>(agent);
  return whitener(s.R[i], agent) * s.H[i];
}

/// (P^-1 + H'R^-1H)^-1, the filtered covariance, without inverting P.
Matrix lambda_II(const Setting& s, const LocalGains& g, int agent) {
  const Matrix h = white_rows(s, agent);
  const Matrix hP = h * g.P;
  const Matrix M = Matrix::Identity(h.rows(), h.rows()) + hP * h.transpose();
  if (h.rows() == 0) return g.P;
  return g.P - hP.transpose() * M.llt().solve(hP);
}

/// (I + H'R^-1H P)^-1
Matrix lambda_III(const Setting& s, const LocalGains& g, int agent) {
  const Matrix h = white_rows(s, agent);
  const Matrix I = Matrix::Identity(s.states(), s.states());
  return (I + h.transpose() * (h * g.P)).partialPivLu().inverse();
}

template <class Block>
Matrix block_diagonal(const Setting& s, const Block& block) {
  const int m = s.states();
  Matrix all = Matrix::Zero(s.size(), s.size());
  for (int i = 0; i < s.agents(); ++i) all.block(i * m, i * m, m, m) = block(i);
  return all;
}

/// M(g) = constant + g linear - g^2 square at every phase.
struct Quadratic {
  Matrix linear, square;
};

struct Decrease {
  Matrix constant;
  std::vector<Quadratic> phases;

  Decrease(const Setting& s, const std::vector<LocalGains>& gains, std::int64_t first, int count) {
    const auto of = [&](int i) -> const LocalGains& { return gains[static_cast<std::size_t>(i)]; };
    constant = block_diagonal(s, [&](int i) { return lambda_I(s, of(i), i); });
    const Matrix II = block_diagonal(s, [&](int i) { return lambda_II(s, of(i), i); });
    const Matrix III = block_diagonal(s, [&](int i) { return lambda_III(s, of(i), i); });
    for (int f = 0; f < count; ++f) {
      const Matrix Lc = Matrix(coupling(s, first + f));
      const Matrix half = III * Lc;
      const Matrix square = Lc.transpose() * (II * Lc);
      phases.push_back({half + half.transpose(), (square + square.transpose()) / 2.0});
    }
  }
  Matrix at(double gamma, std::size_t f) const {
    return constant + gamma * phases[f].linear - gamma * gamma * phases[f].square;
  }
  bool holds(double gamma) const {
    for (std::size_t f = 0; f < phases.size(); ++f)
      if (garrison::detail::least_eigenvalue(at(gamma, f)) < -kSlack) return false;
    return true;
  }
};

}  // namespace

Matrix lambda_I(const Setting& s, const LocalGains& g, int agent) {
  const Matrix h = white_rows(s, agent);
  if (h.rows() == 0) return Matrix::Zero(s.states(), s.states());
  const Matrix M = Matrix::Identity(h.rows(), h.rows()) + h * g.P * h.transpose();
  const Matrix L = h.transpose() * M.llt().solve(h);
  return (L + L.transpose()) / 2.0;
}

namespace {

/// Least eigenvalue of a positive semidefinite matrix, 0 where it is nothing but rounding of 0.
double information(const Matrix& L) {
  const double rounding =
      16.0 * static_cast<double>(L.rows()) * std::numeric_limits<double>::epsilon() * L.norm();
  const double found = garrison::detail::least_eigenvalue(L);
  return found > rounding ? found : 0.0;
}

}  // namespace

double gamma_star(const Setting& s, const std::vector<LocalGains>& gains, double fraction) {
  const int m = s.states();
  double weakest = kInfinity;
  Matrix middle = Matrix::Zero(s.size(), s.size());
  Matrix laplacian = Matrix::Zero(s.agents(), s.agents());
  for (int i = 0; i < s.agents(); ++i) {
    const LocalGains& g = gains[static_cast<std::size_t>(i)];
    weakest = std::min(weakest, information(lambda_I(s, g, i)));
    middle.block(i * m, i * m, m, m) = lambda_II(s, g, i);
    for (const int j : s.hears[static_cast<std::size_t>(i)]) {
      laplacian(i, i) += 1.0;
      laplacian(i, j) -= 1.0;
    }
  }
  Matrix spread(s.size(), s.size());  // Lap (x) I
  for (int i = 0; i < s.agents(); ++i)
    for (int j = 0; j < s.agents(); ++j)
      spread.block(i * m, j * m, m, m) = laplacian(i, j) * Matrix::Identity(m, m);
  const Matrix coupled = spread.transpose() * middle * spread;
  const double strongest = -garrison::detail::least_eigenvalue(-(coupled + coupled.transpose()) / 2.0);
  if (!(strongest > 0.0) || !(fraction > 0.0)) return kInfinity;
  return std::sqrt(std::max(weakest, 0.0) / (fraction * strongest));
}

Matrix decrease_matrix(const Setting& s, const std::vector<LocalGains>& gains, double gamma,
                       std::int64_t phase) {
  return Decrease(s, gains, phase, 1).at(gamma, 0);
}

double gamma_lyapunov(const Setting& s, const std::vector<LocalGains>& gains) {
  const Decrease decrease(s, gains, 0, s.selection.period());
  if (decrease.holds(kMostGamma)) return kMostGamma;
  if (!decrease.holds(0.0)) return 0.0;
  double low = 0.0;
  double high = kMostGamma;
  for (int k = 0; k < 200 && high - low > 1e-15 * high; ++k) {
    const double middle = low + (high - low) / 2.0;
    (decrease.holds(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace garrison::partial_sharing
