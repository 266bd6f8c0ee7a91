// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/partial_step.hpp"

#include <algorithm>
#include <cmath>

#include "garrison/kernel/hypotenuse.hpp"

namespace garrison::rdkf {
namespace {

constexpr int kMostSweeps = 60;

double dot(const double* a, const double* b, int count) {
  double sum = 0.0;
  for (int k = 0; k < count; ++k) sum += a[k] * b[k];
  return sum;
}

/// Rotates pairs of rows until their first `inner` entries are orthogonal (one-sided Jacobi: the singular
/// values to full relative accuracy). `rows` rows of `width` numbers one behind the other.
void orthogonalise(double* a, int rows, int width, int inner) {
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double largest = 0.0;
    for (int i = 0; i < rows; ++i) largest = std::max(largest, dot(a + i * width, a + i * width, inner));
    bool turned = false;
    for (int i = 0; i + 1 < rows; ++i)
      for (int j = i + 1; j < rows; ++j) {
        double* const p = a + i * width;
        double* const q = a + j * width;
        const double pp = dot(p, p, inner);
        const double qq = dot(q, q, inner);
        const double pq = dot(p, q, inner);
        // A row that is rounding of zero has no direction.
        if (std::abs(pq) <= 1e-15 * std::sqrt(pp * qq) || std::min(pp, qq) <= 1e-31 * largest) continue;
        const double zeta = (qq - pp) / (2.0 * pq);
        const double tangent = (zeta < 0.0 ? -1.0 : 1.0) / (std::abs(zeta) + hypotenuse(1.0, zeta));
        const double cosine = 1.0 / hypotenuse(1.0, tangent);
        const double sine = cosine * tangent;
        for (int k = 0; k < width; ++k) {
          const double before = p[k];
          p[k] = cosine * before - sine * q[k];
          q[k] = sine * before + cosine * q[k];
        }
        turned = true;
      }
    if (!turned) return;
  }
}

/// x := L^-1 x.
void solve_lower(const Matrix& L, double* x) {
  for (Eigen::Index i = 0; i < L.rows(); ++i) {
    for (Eigen::Index k = 0; k < i; ++k) x[i] -= L(i, k) * x[k];
    x[i] /= L(i, i);
  }
}
/// x := L^-T x.
void solve_upper(const Matrix& L, double* x) {
  for (Eigen::Index i = L.rows(); i-- > 0;) {
    for (Eigen::Index k = i + 1; k < L.rows(); ++k) x[i] -= L(k, i) * x[k];
    x[i] /= L(i, i);
  }
}

void clear(Packed& m) { std::fill(m.values.begin(), m.values.end(), 0.0); }
double& entry(Packed& m, int row, int column) {
  return m.values[static_cast<std::size_t>(column) * static_cast<std::size_t>(m.height) +
                  static_cast<std::size_t>(row)];
}

}  // namespace

void PartialStep::resize(const SensorRows& sensor, bool box) {
  const Eigen::Index q = sensor.C.rows();
  const Eigen::Index n = sensor.C.cols();
  if (q == 0) return;
  made_.assign(static_cast<std::size_t>(q), 0);
  row_.assign(static_cast<std::size_t>(q), 0);
  root_ = Matrix::Zero(q, q);
  room_.assign(static_cast<std::size_t>(q * (2 * n + 2 * q)), 0.0);
  const Matrix square = Matrix::Zero(q, q);
  const Matrix tall = Matrix::Zero(n, q);
  if (box) {
    box_.R = box_.H = square;
    box_.M = tall.transpose();
    box_.W = tall;
    return;
  }
  step_.R = Packed(square);
  step_.K = Packed(tall.transpose());
  step_.W = Packed(tall);
  step_.d.assign(static_cast<std::size_t>(padded(q)), 0.0);
}

/// Whether factors have to be made for these rows.
bool PartialStep::start(const char* present) noexcept {
  if (std::equal(made_.begin(), made_.end(), present)) return false;
  std::copy_n(present, made_.size(), made_.begin());
  count_ = 0;
  for (std::size_t r = 0; r < made_.size(); ++r)
    if (made_[r] != 0) row_[static_cast<std::size_t>(count_++)] = static_cast<int>(r);
  return true;
}

/// root_ = S^-1/2 of the present rows: with S = G G' and V'G of orthogonal rows of length s, S = V s^2 V'.
void PartialStep::whiten(const SensorRows& sensor) noexcept {
  const int m = count_;
  const int width = 2 * m;
  double* const a = room_.data();
  for (int i = 0; i < m; ++i) {
    double* const row = a + i * width;
    std::fill_n(row, width, 0.0);
    row[m + i] = 1.0;
    for (int j = 0; j <= i; ++j) {
      const double* const other = a + j * width;
      const double rest =
          sensor.S(row_[static_cast<std::size_t>(i)], row_[static_cast<std::size_t>(j)]) - dot(row, other, j);
      row[j] = i == j ? std::sqrt(rest) : rest / other[j];
    }
  }
  orthogonalise(a, m, width, m);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      root_(i, j) = 0.0;
      for (int k = 0; k < m; ++k) {
        const double* const row = a + k * width;
        root_(i, j) += row[m + i] * row[m + j] / std::sqrt(dot(row, row, m));
      }
    }
}

const StepFactors& PartialStep::step(const SensorRows& sensor, const Matrix& L, Penalty penalty,
                                     const char* present) noexcept {
  if (!start(present)) return step_;
  whiten(sensor);
  const int m = count_;
  const auto n = static_cast<int>(L.rows());
  const int width = 2 * n + m;
  // Rows M L^-T, S^-1/2 and M side by side, turned together by V'.
  double* const a = room_.data();
  double largest = 0.0;
  for (int i = 0; i < m; ++i) {
    double* const row = a + i * width;
    for (int k = 0; k < n; ++k) {
      row[k] = 0.0;
      for (int j = 0; j < m; ++j) row[k] += root_(i, j) * sensor.C(row_[static_cast<std::size_t>(j)], k);
      row[n + m + k] = row[k];
    }
    for (int j = 0; j < m; ++j) row[n + j] = root_(i, j);
    solve_lower(L, row);
  }
  orthogonalise(a, m, width, n);
  for (int i = 0; i < m; ++i) largest = std::max(largest, dot(a + i * width, a + i * width, n));
  const double rounding = 1e-14 * std::sqrt(largest) * std::max(m, n);
  clear(step_.R);
  clear(step_.K);
  clear(step_.W);
  std::fill(step_.d.begin(), step_.d.end(), 0.0);
  for (int i = 0; i < m; ++i) {
    double* const row = a + i * width;
    const double square = dot(row, row, n);
    const bool seen = std::sqrt(square) > rounding;
    step_.d[static_cast<std::size_t>(i)] =
        ((seen ? square : 0.0) + (penalty == Penalty::huber ? 1.0 : 0.0)) / 2.0;
    for (int j = 0; j < m; ++j) entry(step_.R, i, row_[static_cast<std::size_t>(j)]) = row[n + j];
    if (!seen) continue;
    solve_upper(L, row);
    for (int k = 0; k < n; ++k) {
      entry(step_.K, i, k) = row[n + m + k];
      entry(step_.W, k, i) = row[k] / 2.0;
    }
  }
  return step_;
}

const BoxFactors& PartialStep::box(const SensorRows& sensor, const Matrix& L, const char* present) noexcept {
  if (!start(present)) return box_;
  whiten(sensor);
  const auto n = static_cast<int>(L.rows());
  box_.R.setZero();
  box_.M.setZero();
  box_.W.setZero();
  box_.H.setZero();
  double* const w = room_.data();
  for (int i = 0; i < count_; ++i) {
    const int at = row_[static_cast<std::size_t>(i)];
    for (int j = 0; j < count_; ++j) box_.R(at, row_[static_cast<std::size_t>(j)]) = root_(i, j);
    for (int k = 0; k < n; ++k) {
      w[k] = 0.0;
      for (int j = 0; j < count_; ++j) w[k] += root_(i, j) * sensor.C(row_[static_cast<std::size_t>(j)], k);
      box_.M(at, k) = w[k];
    }
    solve_lower(L, w);
    solve_upper(L, w);
    for (int k = 0; k < n; ++k) box_.W(k, at) = w[k] / 2.0;
  }
  double largest = 0.0;
  for (int i = 0; i < count_; ++i)
    for (int j = 0; j <= i; ++j) {
      const int r = row_[static_cast<std::size_t>(i)];
      const int c = row_[static_cast<std::size_t>(j)];
      double sum = 0.0;
      for (int k = 0; k < n; ++k) sum += 0.5 * (box_.M(r, k) * box_.W(k, c) + box_.M(c, k) * box_.W(k, r));
      box_.H(r, c) = box_.H(c, r) = sum;
      if (r == c) largest = std::max(largest, sum);
    }
  box_.proximal = proximal_weight(largest);
  return box_;
}

}  // namespace garrison::rdkf
