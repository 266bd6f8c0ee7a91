// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/partial_sharing/attack.hpp"

#include <algorithm>
#include <numeric>

#include "core/solvers.hpp"

namespace garrison::partial_sharing {
namespace {

Matrix restricted(const Setting& s, const Matrix& whole, const std::vector<int>& agents) {
  const int m = s.states();
  const auto B = static_cast<Eigen::Index>(agents.size());
  Matrix part(B * m, B * m);
  for (Eigen::Index i = 0; i < B; ++i)
    for (Eigen::Index j = 0; j < B; ++j)
      part.block(i * m, j * m, m, m) =
          whole.block(agents[static_cast<std::size_t>(i)] * m, agents[static_cast<std::size_t>(j)] * m, m, m);
  return part;
}

WorstCovariance optimum(Matrix form, std::vector<int> byzantine, double energy) {
  WorstCovariance w;
  w.byzantine = std::move(byzantine);
  w.form = (form + form.transpose()) / 2.0;
  w.direction = Vector::Zero(w.form.rows());
  w.covariance = Matrix::Zero(w.form.rows(), w.form.rows());
  if (w.form.rows() == 0 || !(w.form.cwiseAbs().maxCoeff() > 0.0)) return w;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(w.form);
  Vector v = eigen.eigenvectors().col(w.form.rows() - 1);
  for (Eigen::Index k = 0; k < v.size(); ++k)
    if (w.form.row(k).isZero(0.0)) v(k) = 0.0;  // entries that cannot matter carry no rounding
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  w.direction = v * (v(largest) < 0.0 ? -1.0 : 1.0) / v.norm();
  w.gain = energy * eigen.eigenvalues()(w.form.rows() - 1);
  w.covariance = energy * w.direction * w.direction.transpose();
  return w;
}

void require(const Setting& s, std::vector<int>& byzantine, double energy) {
  check_byzantine(s, byzantine);
  std::sort(byzantine.begin(), byzantine.end());
  if (!(energy >= 0.0) || !std::isfinite(energy))
    refuse("energy (eta)", text(energy), "a finite number >= 0");
}

}  // namespace

WorstCovariance worst_one_step(const Setting& s, const std::vector<LocalGains>& gains,
                               std::vector<int> byzantine, double energy, std::int64_t k) {
  require(s, byzantine, energy);
  const Sparse Ga = attack_step(s, gains, k);
  return optimum(restricted(s, Matrix(Sparse(Ga.transpose() * Ga)), byzantine), byzantine, energy);
}

Matrix steady_attack_matrix(const Setting& s, const std::vector<LocalGains>& gains) {
  const std::vector<Matrix> W = periodic_adjoint(s, gains);
  Matrix sum = Matrix::Zero(s.size(), s.size());
  for (std::size_t f = 0; f < W.size(); ++f) {
    const Sparse transposed = attack_step(s, gains, static_cast<std::int64_t>(f)).transpose();
    const Matrix half = transposed * W[(f + 1) % W.size()];
    sum += transposed * half.transpose();
  }
  return (sum + sum.transpose()) / (2.0 * static_cast<double>(W.size()));
}

WorstCovariance worst_steady(const Setting& s, const std::vector<LocalGains>& gains,
                             std::vector<int> byzantine, double energy) {
  require(s, byzantine, energy);
  return optimum(restricted(s, steady_attack_matrix(s, gains), byzantine), byzantine, energy);
}

Matrix spread_covariance(const Setting& s, const std::vector<int>& byzantine, const Matrix& block) {
  check_byzantine(s, byzantine);
  const int m = s.states();
  const auto B = static_cast<Eigen::Index>(byzantine.size());
  if (block.rows() != B * m || block.cols() != B * m)
    refuse("Sigma", std::to_string(block.rows()) + " x " + std::to_string(block.cols()),
           std::to_string(B * m) + " x " + std::to_string(B * m),
           "one block of m x m per pair of Byzantine agents");
  Matrix whole = Matrix::Zero(s.size(), s.size());
  for (Eigen::Index i = 0; i < B; ++i)
    for (Eigen::Index j = 0; j < B; ++j)
      whole.block(byzantine[static_cast<std::size_t>(i)] * m, byzantine[static_cast<std::size_t>(j)] * m, m,
                  m) = block.block(i * m, j * m, m, m);
  return whole;
}

std::vector<int> top_degree(const Setting& s, int count) {
  if (count < 0 || count > s.agents())
    refuse("count", std::to_string(count), "0.." + std::to_string(s.agents()) + " agents");
  std::vector<int> heard_by(static_cast<std::size_t>(s.agents()), 0);
  for (const auto& list : s.hears)
    for (const int j : list) ++heard_by[static_cast<std::size_t>(j)];
  std::vector<int> order(heard_by.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return heard_by[static_cast<std::size_t>(a)] > heard_by[static_cast<std::size_t>(b)];
  });
  order.resize(static_cast<std::size_t>(count));
  std::sort(order.begin(), order.end());
  return order;
}

Matrix coupling_form(const Setting& s, const std::vector<LocalGains>& gains,
                     const std::vector<int>& byzantine) {
  check_byzantine(s, byzantine);
  const int m = s.states();
  const auto B = byzantine.size();
  Matrix U = Matrix::Zero(static_cast<Eigen::Index>(B) * m, static_cast<Eigen::Index>(B) * m);
  for (int q = 0; q < s.agents(); ++q) {
    const auto& heard = s.hears[static_cast<std::size_t>(q)];
    const Matrix& C = gains[static_cast<std::size_t>(q)].C;
    const Matrix square = C.transpose() * C;
    for (std::size_t i = 0; i < B; ++i)
      for (std::size_t j = 0; j < B; ++j)
        if (std::binary_search(heard.begin(), heard.end(), byzantine[i]) &&
            std::binary_search(heard.begin(), heard.end(), byzantine[j]))
          U.block(static_cast<Eigen::Index>(i) * m, static_cast<Eigen::Index>(j) * m, m, m) += square;
  }
  return U;
}

}  // namespace garrison::partial_sharing
