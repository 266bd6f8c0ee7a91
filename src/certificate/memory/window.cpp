// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/window.hpp"

#include <algorithm>
#include <cmath>

#include "../require.hpp"
#include "core/spectrum.hpp"
#include "dense.hpp"

namespace garrison::certificate {

Window::Window(int states, int noise, int steps, int sources, int capacity)
    : noise_inputs_(noise), sources_(sources), most_steps_(steps) {
  detail::require_least("states", states, 1);
  detail::require_least("noise", noise, 0);
  detail::require_least("steps", steps, 1);
  detail::require_least("sources", sources, 1);
  detail::require_least("capacity", capacity, 1);
  const double unknowns = states + static_cast<double>(noise) * (steps - 1.0);
  const double rows = unknowns + static_cast<double>(capacity);
  detail::require_room("window", unknowns * rows + sources);
  const auto p = static_cast<Eigen::Index>(unknowns);
  const auto most = static_cast<Eigen::Index>(rows);
  N_.resize(p, most);
  z_.resize(most);
  bias_.resize(most);
  source_.resize(static_cast<std::size_t>(most));
  step_of_.resize(static_cast<std::size_t>(most));
  noise_.resize(static_cast<std::size_t>(most));
  X_.resize(states, p);
  X_room_.resize(states, p);
  o_.resize(states);
  o_room_.resize(states);
  P_room_.resize(states, states);
  begin(steps);
}

void Window::append(double z, int source, int step, double bias, RowNoise noise) noexcept {
  const auto r = static_cast<std::size_t>(rows_);
  z_(rows_) = z;
  bias_(rows_) = bias;
  source_[r] = source;
  step_of_[r] = step;
  noise_[r] = noise;
  ++rows_;
}

void Window::begin(int steps, double process_bound) {
  if (steps < 1 || steps > most_steps_)
    refuse("steps", std::to_string(steps), "1.." + std::to_string(most_steps_));
  const bool bounded = !std::isnan(process_bound);
  if (bounded && !(process_bound >= 1.0 / kHuge && process_bound <= kHuge))
    refuse("process_bound", text(process_bound), "a number > 0, or NaN: Gaussian");
  steps_ = steps;
  step_ = 0;
  unknowns_ = states() + noise_inputs_ * (steps - 1);
  rows_ = 0;
  prior_length_ = 0.0;
  has_prior_ = false;
  X_.setZero();
  X_.leftCols(states()).setIdentity();
  o_.setZero();
  for (int k = states(); k < unknowns_; ++k) {
    N_.col(rows_).setZero();
    N_(k, rows_) = bounded ? 1.0 / process_bound : 1.0;
    append(0.0, -1, -1, bounded ? 1.0 : 0.0, bounded ? RowNoise::bounded : RowNoise::gaussian);
  }
}

void Window::prior(const VectorRef& c0, const MatrixRef& P0, double scale, RowNoise kind) {
  const int n = states();
  detail::require_shape("c0", c0, n, 1);
  detail::require_shape("P0", P0, n, n);
  if (has_prior_ || rows_ > unknowns_ - n || step_ > 0)
    refuse("prior", has_prior_ ? "a second one" : "one after a row or a step",
           "one prior, right after begin()");
  P_room_ = P0;
  if ((P_room_ - P_room_.transpose()).cwiseAbs().maxCoeff() > 1e-9 * P_room_.cwiseAbs().maxCoeff() ||
      !detail::cholesky(P_room_))
    refuse("P0", "a matrix that is not positive definite", "a covariance without a singular direction");
  // Rows of L^-1 / scale, column by column: what L^-1 makes of a unit vector is column k of L^-1.
  N_.middleCols(rows_, n).setZero();
  for (int k = 0; k < n; ++k) {
    o_room_.setZero();
    o_room_(k) = 1.0 / scale;
    detail::solve_lower(P_room_, o_room_);
    for (int i = 0; i < n; ++i) N_(k, rows_ + i) = o_room_(i);
  }
  for (int i = 0; i < n; ++i) append(N_.col(rows_).head(n).dot(c0), -1, 0, 0.0, kind);
  has_prior_ = true;
}

void Window::prior_gaussian(const VectorRef& c0, const MatrixRef& P0) {
  prior(c0, P0, 1.0, RowNoise::gaussian);
}

void Window::prior_set(const VectorRef& c0, const MatrixRef& P0, double r0, double weight) {
  detail::require_least("r0", r0, 0.0);
  if (!(weight > 1.0 / kHuge && weight <= kHuge)) refuse("weight", text(weight), "a number > 0");
  const double scale = std::max(r0, 1e-9) / weight;  // one standard deviation
  prior(c0, P0, scale, RowNoise::set);
  prior_length_ = r0 / scale;
}

bool Window::add(int source, std::span<const double> c, double y, double variance, double bias,
                 bool bounded) noexcept {
  if (source < 0 || source >= sources_ || rows_ == most_rows() || static_cast<int>(c.size()) != states())
    return false;
  const Eigen::Map<const Vector> row(c.data(), X_.rows());
  const double largest = row.cwiseAbs().maxCoeff();
  if (!row.allFinite() || !(largest > 0.0 && largest <= kHuge) || !(std::abs(y) <= kHuge) ||
      !(variance > 1.0 / kHuge && variance <= kHuge) || !(bias >= 0.0 && bias <= kHuge))
    return false;
  const double sigma = std::sqrt(variance);
  const double z = (y - row.dot(o_)) / sigma;
  auto N = N_.col(rows_).head(unknowns_);
  for (int k = 0; k < unknowns_; ++k) N(k) = row.dot(X_.col(k)) / sigma;
  if (!(std::abs(z) <= kHuge) || !(N.cwiseAbs().maxCoeff() <= kHuge)) return false;
  append(z, source, step_, bias / sigma, bounded ? RowNoise::bounded : RowNoise::gaussian);
  return true;
}

void Window::advance(const MatrixRef& A, const MatrixRef& Gam, const VectorRef& u) {
  const int n = states();
  if (step_ + 1 >= steps_)
    refuse("advance", "step " + std::to_string(step_ + 1), "steps below " + std::to_string(steps_));
  if (A.rows() != n || A.cols() != n) refuse("A", detail::shape(A), detail::shape(P_room_));
  if (Gam.rows() != n || Gam.cols() != noise_inputs_)
    refuse("Gam", detail::shape(Gam), std::to_string(n) + " x " + std::to_string(noise_inputs_));
  if (u.size() != n) refuse("u", amount(u.size(), "number"), std::to_string(n));
  for (int k = 0; k < unknowns_; ++k) X_room_.col(k) = A.lazyProduct(X_.col(k));
  if (noise_inputs_ > 0) X_room_.middleCols(n + noise_inputs_ * step_, noise_inputs_) += Gam;
  X_.leftCols(unknowns_) = X_room_.leftCols(unknowns_);
  o_room_ = A.lazyProduct(o_) + u;
  o_.swap(o_room_);
  ++step_;
}

Matrix noise_root(const MatrixRef& Q) {
  constexpr double kNone = 1e-14;  // of the largest, in those units
  if (Q.rows() < 1) refuse("Q", detail::shape(Q), "at least 1 x 1");
  detail::require_covariance("Q", Q, Q.rows());
  const Matrix root = garrison::detail::covariance_root(Q);
  const Vector scale = Q.diagonal().cwiseMax(0.0).cwiseSqrt();
  Vector size = Vector::Zero(root.cols());
  for (Eigen::Index i = 0; i < root.rows(); ++i)
    if (scale(i) > 0.0) size += (root.row(i).transpose() / scale(i)).cwiseAbs2();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < size.size(); ++k)
    if (size(k) > kNone * size.maxCoeff()) kept.push_back(k);
  return root(Eigen::all, kept);
}

}  // namespace garrison::certificate
