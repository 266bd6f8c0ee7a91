// SPDX-License-Identifier: Apache-2.0
// Random systems over a few steps for the certificates with memory: noise at the edge of the events of the
// theorems, and attacks that hide.
#pragma once

#include <cmath>

#include "../random_network.hpp"
#include "core/solvers.hpp"
#include "garrison/certificate/memory/levels.hpp"
#include "garrison/certificate/memory/window.hpp"

namespace garrison::test {

using namespace garrison::certificate;

enum class Prior { none, gaussian, set };

struct WindowCase {
  int n, q, steps, sources, s;
  bool moving, bounded;
  bool random = false;  // noise as it comes, not at the edge
  Prior prior;
  std::vector<Matrix> A, Gam;
  std::vector<Vector> u;
  struct Row {
    int step, source;
    Vector c;
    double variance, bias;
    double noise = 0.0, y = 0.0;  // in standard deviations; the measurement
  };
  std::vector<Row> rows;
  std::vector<std::vector<int>> attacked;  // per step
  Vector x0, c0;
  Matrix P0, root0;  // P0 = root0 root0'
  double r0 = 1.0, weight = 4.0, process_bound = 1.0;
  Matrix w;               // q x (steps-1)
  std::vector<Vector> x;  // the truth
  WindowLevels levels{3.0, 3.2, 2.8, kNaN};

  bool lies(const Row& row) const {
    return contains(attacked[static_cast<std::size_t>(row.step)], row.source);
  }

  Window window() const {
    Window built(n, q, steps, sources, static_cast<int>(rows.size()));
    built.begin(steps, bounded ? process_bound : kNaN);
    if (prior == Prior::gaussian) built.prior_gaussian(c0, P0);
    if (prior == Prior::set) built.prior_set(c0, P0, r0, weight);
    for (int k = 0; k < steps; ++k) {
      for (const Row& row : rows)
        if (row.step == k)
          built.add(row.source, {row.c.data(), static_cast<std::size_t>(n)}, row.y, row.variance,
                    bounded ? row.bias + 2.0 * std::sqrt(row.variance) : row.bias, bounded);
      if (k + 1 < steps)
        built.advance(A[static_cast<std::size_t>(k)], Gam[static_cast<std::size_t>(k)],
                      u[static_cast<std::size_t>(k)]);
    }
    return built;
  }
};

inline WindowCase draw_window(Rng& rng, bool moving, bool bounded) {
  WindowCase d;
  d.n = whole(rng, 1, 3);
  d.q = whole(rng, 0, d.n);
  d.steps = whole(rng, 1, 5);
  d.sources = whole(rng, 3, 8);
  d.s = whole(rng, 0, std::min(2, d.sources - 1));
  d.moving = moving;
  d.bounded = bounded;
  d.prior = bounded ? Prior::none : static_cast<Prior>(whole(rng, 0, 2));
  const double noise = std::pow(10.0, uniform(rng, -2.0, 0.0));
  for (int k = 0; k + 1 < d.steps; ++k) {
    Matrix A = Matrix::Identity(d.n, d.n) + 0.3 * normal_matrix(rng, d.n, d.n);
    if (whole(rng, 0, 4) == 0) A.row(0).setZero();  // singular
    d.A.push_back(A);
    d.Gam.push_back(noise * normal_matrix(rng, d.n, d.q));
    d.u.push_back(normal_matrix(rng, d.n, 1));
  }
  std::vector<int> outputs;
  for (int j = 0; j < d.sources; ++j) outputs.push_back(whole(rng, 1, 2));
  for (int k = 0; k < d.steps; ++k)
    for (int j = 0; j < d.sources; ++j)
      for (int more = outputs[static_cast<std::size_t>(j)]; more > 0; --more)
        if (whole(rng, 0, 9) > 0)  // else missing
          d.rows.push_back({k, j, unit_vector(rng, d.n), std::pow(10.0, uniform(rng, -2.0, 0.5)),
                            whole(rng, 0, 3) == 0 ? uniform(rng, 0.0, 0.3) : 0.0, 0.0, 0.0});
  const std::vector<int> fixed = choose(rng, whole(rng, 0, d.s), d.sources);
  for (int k = 0; k < d.steps; ++k)
    d.attacked.push_back(moving ? choose(rng, whole(rng, 0, d.s), d.sources) : fixed);
  d.x0 = 5.0 * normal_matrix(rng, d.n, 1);
  d.root0 = 0.7 * Matrix::Identity(d.n, d.n) + 0.3 * normal_matrix(rng, d.n, d.n);
  d.P0 = d.root0 * d.root0.transpose() + 1e-3 * Matrix::Identity(d.n, d.n);
  d.root0 = Eigen::LLT<Matrix>(d.P0).matrixL();
  d.r0 = uniform(rng, 0.3, 3.0);
  d.weight = uniform(rng, 2.0, 20.0);
  d.process_bound = uniform(rng, 0.2, 2.0);
  d.c0 = d.x0;
  d.w = Matrix::Zero(d.q, std::max(0, d.steps - 1));
  return d;
}

/// How far the events of the theorems allow Gaussian noise e (per row of the window, 0 where it is not
/// Gaussian) to be stretched, for the sets of rows that `uses` accepts.
template <class Uses>
double allowed_stretch(const Window& w, const Vector& e, const WindowLevels& z, const Uses& uses) {
  const int p = w.unknowns();
  Matrix G = Matrix::Zero(p, p);
  Matrix noise = G;  // of the Gaussian rows
  Vector sum = Vector::Zero(p);
  for (int r = 0; r < w.rows(); ++r) {
    if (!uses(r)) continue;
    G += w.N(r) * w.N(r).transpose();
    if (w.noise(r) == RowNoise::gaussian) noise += w.N(r) * w.N(r).transpose();
    sum += e(r) * w.N(r);
  }
  const Vector scale = G.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Matrix scaled = scale.cwiseInverse().asDiagonal() * G * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(scaled);
  if (!(eigen.eigenvalues()(0) > 1e-10 * eigen.eigenvalues()(p - 1))) return kInfinity;
  const Matrix inverse = scale.cwiseInverse().asDiagonal() * Matrix(eigen.operatorInverseSqrt()) *
                         Matrix(eigen.operatorInverseSqrt()) * scale.cwiseInverse().asDiagonal();
  const Vector d = inverse * sum;
  double used = 0.0;
  const auto limit = [&](double size, double level) {
    if (size > 1e-9) used = std::max(used, size / std::max(level, 1e-12));
  };
  for (int r = 0; r < w.rows(); ++r) {
    if (!uses(r)) continue;
    const double lev = w.N(r).dot(inverse * w.N(r));
    limit(std::abs(e(r)), z.z1);
    limit(std::abs(w.N(r).dot(d)), z.z1 * std::sqrt(lev));
    limit(std::abs(e(r) - w.N(r).dot(d)), z.z1 * std::sqrt(std::max(0.0, 1.0 - lev)));
  }
  const Vector g = w.E() * d;
  const Matrix spread = w.E() * inverse * noise * inverse * w.E().transpose();
  for (Eigen::Index i = 0; i < g.size(); ++i)
    limit(std::abs(g(i)), z.zc * std::sqrt(std::max(spread(i, i), 0.0)));
  const Eigen::SelfAdjointEigenSolver<Matrix> of(spread);
  double length2 = 0.0;
  for (Eigen::Index i = 0; i < g.size(); ++i)
    if (of.eigenvalues()(i) > 1e-13 * of.eigenvalues()(g.size() - 1))
      length2 += std::pow(of.eigenvectors().col(i).dot(g), 2) / of.eigenvalues()(i);
  limit(std::sqrt(length2), z.z2);
  return used > 0.0 ? 1.0 / used : 1.0;
}

/// Every row's noise to the edge of the events of W2M and W3M, then the true run, then what everybody says.
inline void play(Rng& rng, WindowCase& d) {
  const Window w = d.window();
  Vector e = Vector::Zero(w.rows());
  const Vector along = normal_matrix(rng, w.unknowns(), 1);
  const bool aligned = !d.random && whole(rng, 0, 1) == 0;
  for (int r = 0; r < w.rows(); ++r)
    if (w.noise(r) == RowNoise::gaussian)
      e(r) = aligned ? w.N(r).dot(along) / (1e-9 + w.N(r).norm()) : std::normal_distribution<>()(rng);
  std::vector<char> ever(static_cast<std::size_t>(d.sources), 0);
  for (const auto& set : d.attacked)
    for (const int j : set) ever[static_cast<std::size_t>(j)] = 1;
  const auto honest = [&](int r) {
    return w.source(r) < 0 || !contains(d.attacked[static_cast<std::size_t>(w.step_of(r))], w.source(r));
  };
  double stretch = allowed_stretch(w, e, d.levels, honest);
  if (!d.moving)  // the sets that W3M may keep: all but s sources, the attacked among them
    for (unsigned set = 0; set < (1U << d.sources); ++set) {
      int size = 0;
      bool covers = true;
      for (int j = 0; j < d.sources; ++j) {
        size += static_cast<int>((set >> j) & 1U);
        covers = covers && (ever[static_cast<std::size_t>(j)] == 0 || ((set >> j) & 1U) != 0);
      }
      if (size != d.s || !covers) continue;
      stretch = std::min(stretch, allowed_stretch(w, e, d.levels, [&](int r) {
                           return w.source(r) < 0 || ((set >> w.source(r)) & 1U) == 0;
                         }));
    }
  if (!std::isfinite(stretch)) stretch = 1.0;
  if (!d.random) e *= std::min(stretch, 100.0) * (1.0 - 1e-9);
  // The truth: process noise and start as the rows of the regression see them.
  int r = 0;
  for (int k = 0; k + 1 < d.steps; ++k)
    for (int i = 0; i < d.q; ++i, ++r) d.w(i, k) = d.bounded ? d.process_bound * sign(rng) : -e(r);
  if (d.prior == Prior::gaussian) {
    d.c0 = d.x0 + d.root0 * e.segment(r, d.n);
    r += d.n;
  } else if (d.prior == Prior::set) {
    d.c0 = d.x0 + d.r0 * d.root0 * unit_vector(rng, d.n);
    r += d.n;
  }
  d.x.assign(1, d.x0);
  for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(d.steps); ++k)
    d.x.push_back(d.A[k] * d.x[k] + d.u[k] + d.Gam[k] * d.w.col(static_cast<Eigen::Index>(k)));
  // Another run that the attackers may all show: far off, or where the honest rows see least.
  const int kind = whole(rng, 0, 4);
  const double size = std::pow(10.0, uniform(rng, -0.5, 2.0));
  Vector shift = size * unit_vector(rng, d.n);
  if (kind == 4) {
    Matrix seen = Matrix::Zero(d.n, d.n);
    Matrix power = Matrix::Identity(d.n, d.n);
    for (int k = 0; k < d.steps; ++k) {
      for (const auto& row : d.rows)
        if (row.step == k && !d.lies(row))
          seen += power.transpose() * row.c * row.c.transpose() * power / row.variance;
      if (k + 1 < d.steps) power = d.A[static_cast<std::size_t>(k)] * power;
    }
    shift = size * Eigen::SelfAdjointEigenSolver<Matrix>(seen).eigenvectors().col(0);
  }
  std::vector<Vector> other(1, d.x0 + shift);
  for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(d.steps); ++k)
    other.push_back(d.A[k] * (other[k] - d.x[k]) + d.x[k + 1]);
  for (auto& row : d.rows) {
    const double sigma = std::sqrt(row.variance);
    const auto k = static_cast<std::size_t>(row.step);
    const double truth = row.c.dot(d.x[k]);
    const double noise =
        d.bounded ? sign(rng) * (2.0 * sigma + row.bias) : sigma * e(r) + sign(rng) * row.bias;
    ++r;
    if (!d.lies(row))
      row.y = truth + noise;
    else if (kind == 0)
      row.y = truth + noise + size;  // constant
    else if (kind == 1)
      row.y = whole(rng, 0, 2) == 0 ? kNaN : truth + sign(rng) * size * 1e3;  // loud, or silent
    else if (kind == 2)
      row.y = size * std::normal_distribution<>()(rng);
    else
      row.y = row.c.dot(other[k]) + noise;  // a false trajectory
  }
}

}  // namespace garrison::test
