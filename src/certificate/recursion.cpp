// SPDX-License-Identifier: Apache-2.0
#include "recursion.hpp"

#include <algorithm>

#include "require.hpp"
#include "top.hpp"

namespace garrison::certificate::detail {

Recursion::Recursion(const Kernels& kernels, const TableOptions& options, Gains noise_d, Gains noise_eta)
    : k_(kernels),
      o_(options),
      noise_d_(std::move(noise_d)),
      noise_eta_(std::move(noise_eta)),
      room_(static_cast<std::size_t>(kernels.system.agents())) {}

Inputs Recursion::inputs(const Vector& H0, const Vector& b) const {
  Inputs in;
  in.H = H0 + b;
  in.level = o_.beta ? Vector::Constant(H0.size(), *o_.beta) : in.H;
  in.theta = in.level + H0 - b;
  in.psi = (in.H - in.level).cwiseMax(0.0);
  for (Eigen::Index j = 0; j < H0.size(); ++j) {
    if (k_.system.row_length(j) != 0.0) continue;
    in.theta(j) = 0.0;
    in.psi(j) = 0.0;
  }
  return in;
}

/// What attack and clipping add to one agent over m lags.
double Recursion::attacked(const std::vector<Gains>& g, Eigen::Index i, int m,
                           const std::function<const Inputs&(int)>& at) {
  double sum = 0.0;
  Eigen::Map<Vector> z(room_.data(), static_cast<Eigen::Index>(room_.size()));
  if (o_.fixed) {
    z.setZero();
    for (int k = 0; k < m; ++k)
      z += g[static_cast<std::size_t>(k)].row(i).transpose().cwiseProduct(at(k).theta);
    sum += top(room_, o_.s);
  } else {
    for (int k = 0; k < m; ++k) {
      z = g[static_cast<std::size_t>(k)].row(i).transpose().cwiseProduct(at(k).theta);
      sum += top(room_, o_.s);
    }
  }
  if (o_.beta)  // otherwise nobody honest is clipped
    for (int k = 0; k < m; ++k) sum += g[static_cast<std::size_t>(k)].row(i).dot(at(k).psi);
  return sum;
}

void Recursion::step(int m, const std::function<const Inputs&(int)>& at, const Vector& before, Vector& d,
                     Vector& eta) {
  const auto lag = static_cast<std::size_t>(m);
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    d(i) = noise_d_(m, i) + attacked(k_.gb, i, m, at) + k_.Rb[lag].row(i).dot(before);
    eta(i) = noise_eta_(m, i) + attacked(k_.ge, i, m, at) + k_.Re[lag].row(i).dot(before);
  }
}

Table Recursion::run(const std::function<Inputs(int, const Vector&)>& next) {
  const Eigen::Index N = k_.system.agents();
  const int K = k_.window();
  const Gains absent = Gains::Constant(o_.T + 1, N, kInfinity);
  Table t{absent, absent, absent, absent, {}};
  t.H.row(0).setConstant(kNaN);
  t.level.row(0).setConstant(kNaN);
  Vector d = Vector::Constant(N, o_.start);
  Vector eta = k_.system.CA.rowwise().norm() * o_.start;
  t.d.row(0) = d;
  t.eta.row(0) = eta;
  std::vector<Inputs> past(static_cast<std::size_t>(K));  // of the last K steps, at t mod K
  const auto slot = [&](int step) -> Inputs& { return past[static_cast<std::size_t>(step % K)]; };
  for (int now = 1; now <= o_.T; ++now) {
    const int m = std::min(now, K);
    slot(now) = next(now, eta);
    t.H.row(now) = slot(now).H;
    t.level.row(now) = slot(now).level;
    const Vector before = t.d.row(now - m);
    step(m, [&](int k) -> const Inputs& { return slot(now - k); }, before, d, eta);
    if (!(d.allFinite() && eta.allFinite())) return t;  // the rest stays infinite
    t.d.row(now) = d;
    t.eta.row(now) = eta;
  }
  return t;
}

std::optional<Steady> Recursion::steady(const Table& table,
                                        const std::function<Inputs(const Vector&)>& next) {
  const int K = k_.window();
  if (o_.T < K + 2 || !table.d.row(o_.T).allFinite()) return {};
  const Vector D = 1.001 * table.d.bottomRows(K + 1).colwise().maxCoeff().transpose();
  const Vector E = 1.001 * table.eta.bottomRows(K + 1).colwise().maxCoeff().transpose();
  const Inputs in = next(E);
  Vector d(D.size());
  Vector eta(D.size());
  step(K, [&](int) -> const Inputs& { return in; }, D, d, eta);
  if (!(d.array() <= D.array()).all() || !(eta.array() <= E.array()).all()) return {};
  return Steady{D, E};
}

void require_table(const Kernels& kernels, const TableOptions& o) {
  require_least("s", o.s, 0);
  require_least("start", o.start, 0.0);
  require_least("T", o.T, 1);
  if (o.beta) require_least("beta", *o.beta, 0.0);
  require_room("T", 4.0 * (o.T + 1.0) * static_cast<double>(kernels.system.agents()));
}

}  // namespace garrison::certificate::detail
