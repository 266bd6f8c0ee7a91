// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/platoon/loop.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/solvers.hpp"
#include "garrison/filters/platoon/detector.hpp"
#include "garrison/filters/platoon/formation.hpp"

namespace garrison::platoon {
namespace {

void require_vehicles(int vehicles) {
  if (vehicles < 1) refuse("vehicles (N)", std::to_string(vehicles), "at least 1");
  require_memory("vehicles (N)", std::to_string(vehicles), 100.0 * vehicles);  // some 2 x 2 matrices each
}

void require_loop(int vehicles, double period, double gs, double gv) {
  require_vehicles(vehicles);
  if (!(period > 0.0) || !std::isfinite(period)) refuse("period (T)", text(period), "a finite number > 0");
  if (!std::isfinite(gs)) refuse("gs", text(gs), "a finite gain");
  if (!std::isfinite(gv)) refuse("gv", text(gv), "a finite gain");
}

/// sigma_l of L_g.
double eigenvalue(int l, int vehicles) {
  return 2.0 - 2.0 * std::cos((2.0 * l - 1.0) * std::numbers::pi / (2.0 * vehicles + 1.0));
}

/// Q_l = A - sigma_l F_0.
Mat<2> block(double sigma, double T, double gs, double gv) {
  Mat<2> Q;
  Q << 1.0, T, -sigma * T * gs, 1.0 - sigma * T * gv;
  return Q;
}

double radius(const Mat<2>& Q) {
  const double half = Q.trace() / 2.0;
  const double root = half * half - Q.determinant();
  return root < 0.0 ? std::sqrt(Q.determinant()) : std::abs(half) + std::sqrt(root);
}

double norm(const Mat<2>& Q) {
  // Largest singular value: sum and difference of the two.
  const double plus = length(Q(0, 0) + Q(1, 1), Q(1, 0) - Q(0, 1));
  const double minus = length(Q(0, 0) - Q(1, 1), Q(1, 0) + Q(0, 1));
  return (plus + minus) / 2.0;
}

/// M of Q' M Q - M = -I, by its three different entries.
Mat<2> lyapunov(const Mat<2>& Q) {
  const double a = Q(0, 0), b = Q(0, 1), c = Q(1, 0), d = Q(1, 1);
  Mat<3> S;  // unknowns m11, m12, m22
  S << a * a - 1.0, 2.0 * a * c, c * c, a * b, a * d + b * c - 1.0, c * d, b * b, 2.0 * b * d, d * d - 1.0;
  const Vec<3> m = S.fullPivLu().solve(Vec<3>(-1.0, 0.0, -1.0));
  Mat<2> M;
  M << m(0), m(1), m(1), m(2);
  return M;
}

double summed_powers(std::vector<Mat<2>> Q) {
  std::vector<Mat<2>> power(Q.size(), Mat<2>::Identity());
  double sum = 0.0;
  double work = 0.0;
  for (;;) {
    double term = 0.0;
    for (const Mat<2>& P : power) term = std::max(term, norm(P));
    sum += term;
    if (term < 1e-9) return sum;
    work += static_cast<double>(Q.size());
    if (work > kMostTerms) return kNaN;
    for (std::size_t l = 0; l < Q.size(); ++l) power[l] = (power[l] * Q[l]).eval();
  }
}

}  // namespace

std::vector<double> grounded_eigenvalues(int vehicles) {
  require_vehicles(vehicles);
  std::vector<double> all;
  for (int l = 1; l <= vehicles; ++l) all.push_back(eigenvalue(l, vehicles));
  return all;
}

bool assumption4(int vehicles, double period, double gs, double gv) {
  require_loop(vehicles, period, gs, gv);
  const double T = period;
  return gs > 0.0 && gv > T * gs && T * T * gs - 2.0 * T * gv > -4.0 / eigenvalue(vehicles, vehicles);
}

LoopFactors loop_factors(int vehicles, double period, double gs, double gv) {
  require_loop(vehicles, period, gs, gv);
  LoopFactors f{0.0, kNaN, kNaN, kNaN, kNaN, kNaN};
  std::vector<Mat<2>> Q;
  for (const double sigma : grounded_eigenvalues(vehicles)) {
    Q.push_back(block(sigma, period, gs, gv));
    f.rho = std::max(f.rho, radius(Q.back()));
  }
  if (!(f.rho < 1.0)) return f;
  double MP = 0.0;
  f.M_max = 0.0;
  f.M_min = kInfinity;
  for (const Mat<2>& Ql : Q) {
    const Mat<2> M = lyapunov(Ql);
    const double half = M.trace() / 2.0;
    const double root = length((M(0, 0) - M(1, 1)) / 2.0, M(0, 1));
    f.M_max = std::max(f.M_max, half + root);
    f.M_min = std::min(f.M_min, half - root);
    MP = std::max(MP, norm(M * Ql));
  }
  f.kappa = f.M_max + 2.0 * MP * MP;
  f.xi = std::sqrt(2.0 * f.kappa * f.M_max / f.M_min);
  f.l1 = summed_powers(std::move(Q));
  return f;
}

LoopBound theorem4(int vehicles, double period, double gs, double gv, double eps, double alpha) {
  if (!(eps >= 0.0) || !std::isfinite(eps)) refuse("process_noise (eps)", text(eps), "a finite number >= 0");
  if (!(alpha >= 0.0) || !std::isfinite(alpha)) refuse("alpha", text(alpha), "a finite number >= 0");
  const LoopFactors f = loop_factors(vehicles, period, gs, gv);
  const double root = std::sqrt(static_cast<double>(vehicles));
  LoopBound b{};
  b.eta = 2.0 * root * period * alpha * (gs * (norm_A(period) + 1.0) + 2.0 * gv) + root * eps;
  b.eta_safe = b.eta + 2.0 * root * period * (gs + gv) * eps;
  b.bound = alpha + b.eta * f.xi;
  b.bound_safe = alpha + b.eta_safe * f.xi;
  b.bound_sharp = alpha + b.eta_safe * f.l1 / root;
  b.spacing = std::sqrt(2.0) * b.eta_safe * f.l1;
  return b;
}

Formation formation(const std::string& owner, const std::vector<double>& reference, double spacing, double gs,
                    double gv, double period, int vehicles) {
  if (reference.empty() || reference.size() % 2 != 0)
    refuse(owner + ".reference", amount(reference.size(), "number"),
           "position and velocity for time 0, or for times 0, 1, ...");
  Formation f;
  f.period = period;
  f.spacing = spacing;
  f.gs = gs;
  f.gv = gv;
  for (std::size_t k = 0; k < reference.size(); k += 2) {
    if (!std::isfinite(reference[k]) || !std::isfinite(reference[k + 1]))
      refuse(owner + ".reference", "a number that is not finite at time " + std::to_string(k / 2),
             "finite numbers");
    f.reference.push_back({reference[k], reference[k + 1]});
  }
  if (!std::isfinite(spacing)) refuse(owner + ".spacing", text(spacing), "a finite distance in m");
  if (!assumption4(vehicles, period, gs, gv))
    refuse(owner + ".gs, gv", "gs = " + text(gs) + ", gv = " + text(gv),
           "g_v > T g_s > 0 and T^2 g_s - 2 T g_v > -4/sigma_max = " +
               text(-4.0 / grounded_eigenvalues(vehicles).back()) +
               " (Assumption 4), with T = " + text(period),
           "the controlled string is not stable with these gains");
  return f;
}

}  // namespace garrison::platoon
