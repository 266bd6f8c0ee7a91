// SPDX-License-Identifier: Apache-2.0
// Alarms, windows of residuals, templates, and what an attack can do before it is seen.
#include "garrison/filters/structural/detection.hpp"

#include <algorithm>
#include <cmath>

#include "blocks.hpp"
#include "core/solvers.hpp"

namespace garrison::structural {
namespace {

using Index = Eigen::Index;

void require_columns(const MatrixRef& residuals, Index agents) {
  if (residuals.cols() != agents)
    refuse("residuals", amount(residuals.cols(), "column"), std::to_string(agents) + ", one per agent");
}

int window_of(std::span<const Matrix> covariances) {
  if (covariances.empty()) refuse("covariances", "none", "one (N, N) matrix per lag, at least one");
  const auto N = covariances.front().rows();
  for (std::size_t h = 0; h < covariances.size(); ++h)
    if (covariances[h].rows() != N || covariances[h].cols() != N)
      refuse("covariances[" + std::to_string(h) + "]",
             std::to_string(covariances[h].rows()) + " x " + std::to_string(covariances[h].cols()),
             std::to_string(N) + " x " + std::to_string(N));
  return static_cast<int>(covariances.size());
}

}  // namespace

std::vector<std::vector<int>> alarms(const MatrixRef& residuals, const Vector& threshold) {
  require_columns(residuals, threshold.size());
  std::vector<std::vector<int>> all(static_cast<std::size_t>(residuals.rows()));
  for (Index k = 0; k < residuals.rows(); ++k)
    for (Index i = 0; i < residuals.cols(); ++i)
      if (!(std::abs(residuals(k, i)) < threshold(i)))
        all[static_cast<std::size_t>(k)].push_back(static_cast<int>(i));
  return all;
}

std::vector<Exposure> exposure(const Setting& s, const Stationary& x, double false_alarm, double detection) {
  const double m = level_of_false_alarm(false_alarm);
  if (!(detection > 0.0 && detection < 1.0)) refuse("detection", text(detection), "a probability in (0, 1)");
  // The shift, in standard deviations, that a test at m detects with this probability; power rises with it.
  double lo = 0.0;
  double hi = m + 40.0;
  for (int k = 0; k < 200 && detection > false_alarm; ++k) {
    const double mid = 0.5 * (lo + hi);
    (power(mid, 1.0, m) < detection ? lo : hi) = mid;
  }
  const double shift = detection > false_alarm ? hi : 0.0;
  std::vector<Exposure> all(static_cast<std::size_t>(s.N()));
  for (Index j = 0; j < s.N(); ++j) {
    Exposure& e = all[static_cast<std::size_t>(j)];
    e.smallest_seen = kInfinity;
    for (Index i = 0; i < s.N(); ++i) {
      if (!(x.residual_std(i) > 0.0)) continue;
      const double reaction = std::abs(x.dc_gain(i, j)) / x.residual_std(i);
      const double size = reaction > 0.0 ? shift / reaction : kInfinity;
      if (size < e.smallest_seen) {
        e.smallest_seen = size;
        e.seen_by = static_cast<int>(i);
      }
    }
    e.harm_per_unit = 0.0;
    for (Index i = 0; i < s.N(); ++i)
      e.harm_per_unit = std::max(e.harm_per_unit, x.dc_error.block(i * s.n(), j, s.n(), 1).norm());
    e.largest_harm = e.harm_per_unit == 0.0 ? 0.0 : e.harm_per_unit * e.smallest_seen;
  }
  return all;
}

Matrix windows_naive(const MatrixRef& residuals, const Vector& residual_std, int w) {
  require_columns(residuals, residual_std.size());
  if (w < 1) refuse("window", std::to_string(w), "at least 1");
  Matrix out = Matrix::Constant(residuals.rows(), residuals.cols(), kNaN);
  for (Index k = w - 1; k < residuals.rows(); ++k)
    for (Index i = 0; i < residuals.cols(); ++i)
      out(k, i) = (residuals.col(i).segment(k - w + 1, w) / residual_std(i)).squaredNorm();
  return out;
}

Matrix window_precision(std::span<const Matrix> covariances, int agent) {
  const int w = window_of(covariances);
  Matrix S(w, w);
  for (int a = 0; a < w; ++a)
    for (int b = 0; b < w; ++b)
      S(a, b) = covariances[static_cast<std::size_t>(std::abs(a - b))](agent, agent);
  return detail::pseudo_inverse(S);
}

Matrix windows_exact(const MatrixRef& residuals, std::span<const Matrix> covariances) {
  const int w = window_of(covariances);
  require_columns(residuals, covariances.front().rows());
  Matrix out = Matrix::Constant(residuals.rows(), residuals.cols(), kNaN);
  for (Index i = 0; i < residuals.cols(); ++i) {
    const Matrix precision = window_precision(covariances, static_cast<int>(i));
    for (Index k = w - 1; k < residuals.rows(); ++k) {
      const Vector v = residuals.col(i).segment(k - w + 1, w);
      out(k, i) = v.dot(precision * v);
    }
  }
  return out;
}

Matrix template_statistics(const MatrixRef& residuals, std::span<const Matrix> covariances,
                           const MatrixRef& dc_gain) {
  const int w = window_of(covariances);
  const Index N = covariances.front().rows();
  require_columns(residuals, N);
  if (dc_gain.rows() != N || dc_gain.cols() != N)
    refuse("dc_gain", std::to_string(dc_gain.rows()) + " x " + std::to_string(dc_gain.cols()),
           std::to_string(N) + " x " + std::to_string(N));
  Matrix S(w * N, w * N);
  for (int a = 0; a < w; ++a)
    for (int b = 0; b < w; ++b) {
      const Matrix& G = covariances[static_cast<std::size_t>(std::abs(a - b))];
      if (a >= b)
        S.block(a * N, b * N, N, N) = G;
      else
        S.block(a * N, b * N, N, N) = G.transpose();
    }
  const Matrix precision = detail::pseudo_inverse(0.5 * (S + S.transpose()));
  Matrix templates(w * N, N);
  for (int a = 0; a < w; ++a) templates.middleRows(a * N, N) = dc_gain;
  const Matrix weights = precision * templates;  // columns S^-1 t_j
  const Index windows = std::max<Index>(0, residuals.rows() - w + 1);
  Matrix out(windows, N);
  for (Index r = 0; r < windows; ++r) {
    Vector v(w * N);
    for (int a = 0; a < w; ++a) v.segment(a * N, N) = residuals.row(r + a).transpose();
    for (Index j = 0; j < N; ++j) {
      const double energy = weights.col(j).dot(templates.col(j));
      const double fit = weights.col(j).dot(v);
      out(r, j) = energy > 0.0 ? fit * fit / energy : 0.0;
    }
  }
  return out;
}

}  // namespace garrison::structural
