// SPDX-License-Identifier: Apache-2.0
#include "row_bases.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "garrison/core/random.hpp"

namespace garrison::detail {
namespace {

constexpr double kWorstCondition = 1e6;
/// Weights below this part of the largest are rounding.
constexpr double kNoWeight = 1e-13;
/// Relative rounding of a few sums, and of the bounds.
constexpr double kRounding = 1e-13;
constexpr double kBoundRounding = 1e-9;

double choices(int of, int take) {
  double count = 1.0;
  for (int k = 1; k <= take; ++k) count *= static_cast<double>(of - take + k) / k;
  return count;
}

}  // namespace

RowBases::RowBases(MeasuredRows measured, int most) : measured_(std::move(measured)) {
  const auto n = static_cast<int>(measured_.rows.rows());
  const auto m = static_cast<int>(measured_.rows.cols());
  if (m < n) return;
  if (choices(m, n) <= most)
    all_of_them();
  else
    some(most);
}

bool RowBases::add(const std::vector<int>& members) {
  const Matrix rows = measured_.rows(Eigen::all, members).transpose();
  const Eigen::PartialPivLU<Matrix> lu(rows);
  const Matrix inverse = lu.inverse();
  const double size = inverse.norm();
  const double condition = size * rows.norm();
  if (!(condition < kWorstCondition)) return false;
  members_.push_back(members);
  inverse_.push_back(inverse);
  rounding_.push_back(size * (kRounding + 4.0 * std::numeric_limits<double>::epsilon() * condition));
  return true;
}

void RowBases::all_of_them() {
  const auto n = static_cast<std::size_t>(measured_.rows.rows());
  const auto m = static_cast<int>(measured_.rows.cols());
  std::vector<int> members(n);
  std::iota(members.begin(), members.end(), 0);
  for (;;) {
    add(members);
    std::size_t k = n;
    while (k > 0 && members[k - 1] == m - static_cast<int>(n - k) - 1) --k;
    if (k == 0) return;
    ++members[k - 1];
    for (; k < n; ++k) members[k] = members[k - 1] + 1;
  }
}

/// Each group takes rows in an order drawn at random, those that add a direction.
void RowBases::some(int most) {
  const Eigen::Index n = measured_.rows.rows();
  const auto m = static_cast<std::size_t>(measured_.rows.cols());
  const Random random(0, 0, Purpose::attack);
  std::vector<int> order(m);
  std::iota(order.begin(), order.end(), 0);
  for (int draw = 0; draw < most; ++draw) {
    for (std::size_t k = 0; k + 1 < m; ++k) {
      const double u = random.uniform(draw, static_cast<std::uint32_t>(k));
      std::swap(order[k], order[k + static_cast<std::size_t>(u * static_cast<double>(m - k))]);
    }
    std::vector<int> members;
    Matrix basis(n, n);
    for (std::size_t k = 0; k < m && static_cast<Eigen::Index>(members.size()) < n; ++k) {
      const auto have = static_cast<Eigen::Index>(members.size());
      const Vector row = measured_.rows.col(order[k]);
      Vector rest = row - basis.leftCols(have) * (basis.leftCols(have).transpose() * row);
      if (!(rest.norm() > 1e-3 * row.norm())) continue;
      basis.col(have) = rest.normalized();
      members.push_back(order[k]);
    }
    if (static_cast<Eigen::Index>(members.size()) == n) add(members);
  }
}

void Weighted::leave_out(Sources some) {
  if (some == left_out) return;
  left_out = some;
  for (Eigen::Index g = 0; g < noise.size(); ++g)
    room(g) = (source[static_cast<std::size_t>(g)] & some) != 0 ? kInfinity : noise(g);
}

void RowBases::along(const Vector& direction, Weighted& out) const {
  out.weights.resize(groups(), direction.size());
  out.noise.resize(groups());
  out.source.assign(members_.size(), 0);
  out.length = direction.norm();
  out.left_out = 0;
  for (std::size_t g = 0; g < members_.size(); ++g) {
    const auto at = static_cast<Eigen::Index>(g);
    auto weights = out.weights.row(at);
    weights.noalias() = direction.transpose() * inverse_[g];
    const double least = kNoWeight * weights.cwiseAbs().maxCoeff();
    double noise = 0.0;
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      const auto row = static_cast<std::size_t>(members_[g][static_cast<std::size_t>(k)]);
      if (std::abs(weights(k)) <= least) {
        weights(k) = 0.0;
        continue;
      }
      noise += std::abs(weights(k)) * measured_.bound(static_cast<Eigen::Index>(row));
      out.source[g] |= measured_.source[row];
    }
    out.noise(at) = noise * (1.0 + kBoundRounding);
  }
  out.room = out.noise;
}

void RowBases::read(const double* y, Readings& out) const {
  out.y.resize(groups(), measured_.rows.rows());
  out.rounds.resize(groups());
  for (std::size_t g = 0; g < members_.size(); ++g) {
    const auto at = static_cast<Eigen::Index>(g);
    double squares = 0.0;
    for (std::size_t k = 0; k < members_[g].size(); ++k) {
      const double one = y[members_[g][k]];
      out.y(at, static_cast<Eigen::Index>(k)) = one;
      squares += one * one;
    }
    out.rounds(at) = rounding_[g] * std::sqrt(squares);
    if (std::isfinite(squares)) continue;
    out.y.row(at).setZero();
    out.rounds(at) = kInfinity;
  }
}

Range RowBases::range(const Weighted& direction, const Readings& readings) {
  Range out;
  for (Eigen::Index g = 0; g < readings.rounds.size(); ++g) {
    double middle = 0.0;
    for (Eigen::Index k = 0; k < readings.y.cols(); ++k) middle += direction.weights(g, k) * readings.y(g, k);
    const double half = direction.room(g) + direction.length * readings.rounds(g);
    out.lo = std::max(out.lo, middle - half);
    out.hi = std::min(out.hi, middle + half);
  }
  return out;
}

Sources RowBases::behind(const Weighted& direction, const Readings& readings, bool lower) {
  Eigen::Index last = 0;
  double furthest = -kInfinity;
  for (Eigen::Index g = 0; g < readings.rounds.size(); ++g) {
    const double middle = direction.weights.row(g).dot(readings.y.row(g));
    const double end = (lower ? middle : -middle) - direction.room(g) - direction.length * readings.rounds(g);
    if (!(end > furthest)) continue;
    furthest = end;
    last = g;
  }
  return direction.source[static_cast<std::size_t>(last)];
}

}  // namespace garrison::detail
