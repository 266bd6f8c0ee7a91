// SPDX-License-Identifier: Apache-2.0
// lambda_0 = min over |u| = 1 of F(uu'), F(M) = sum of the N - s smallest c_i'M c_i: the minima over sets and
// over directions swap. F is a minimum of linear functions: F(M + M') >= F(M) + F(M'), F(a M) = a F(M).
// Directions u = V t, t >= 0, of a cone with the columns of V as edges have uu' = sum of t_j t_k v_j v_k', so
//
//   F(uu') >= t'Q t,  Q_jk = F((v_j v_k' + v_k v_j') / 2) = sum of the N - s smallest (c_i'v_j)(c_i'v_k),
//
// and the cone has nothing below the least t'Q t / t'V'V t. This is off by the square of the cone's width,
// and not at all where one set is the best for the whole cone.
#include "directions.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "copositive.hpp"
#include "garrison/core/budget.hpp"
#include "row_groups.hpp"
#include "symmetric_eigen.hpp"

namespace garrison::detail {
namespace {

/// The rounding of this sum grows with the logarithm of its length only.
double sum(const double* values, std::ptrdiff_t size) {
  constexpr std::ptrdiff_t kShort = 16;
  if (size <= kShort) return std::accumulate(values, values + size, 0.0);
  const std::ptrdiff_t half = size / 2;
  return sum(values, half) + sum(values + half, size - half);
}

class Directions {
 public:
  Directions(const MatrixRef& C, int s, const SubsetLimits& limits)
      : C_(C),
        s_(s),
        most_(static_cast<double>(limits.max_nodes) * static_cast<double>(C.rows())),
        budget_(current_budget().within(limits.max_seconds)),
        values_(C.rows()) {}

  SubsetBound run() {
    const Eigen::Index n = C_.cols();
    std::vector<int> all(static_cast<std::size_t>(C_.rows()));
    std::iota(all.begin(), all.end(), 0);
    best_.upper = kInfinity;
    const Small S = outer(all);
    margin_ = kRounding * S.trace();
    Small axes(n, n);
    Vector eigenvalues(n);
    symmetric_eigen(S.data(), n, eigenvalues.data(), axes.data());
    for (Eigen::Index k = 0; k < n; ++k) improve(axes.col(k));
    const auto root = hold({std::move(all), s_, Small::Zero(n, n), S});
    gather(*root);
    for (int signs = 0; signs < 1 << (n - 1); ++signs) {  // u and -u are one direction
      Small V = axes;
      for (Eigen::Index k = 0; k + 1 < n; ++k)
        if ((signs >> k & 1) != 0) V.col(k) *= -1.0;
      look(V, root);
    }
    while (!open_.empty() && open_.front().lower < best_.upper - margin_ && !out_of_budget()) split();
    const double lower = open_.empty() ? best_.upper : std::min(best_.upper, open_.front().lower);
    best_.exact = lower >= best_.upper - margin_;
    best_.lower = std::max(lower - 2.0 * margin_, 0.0);  // a cone goes within one, its bound is off by one
    best_.method = "directions";
    return best_;
  }

 private:
  static constexpr std::size_t kMostCones =
      4'000'000;  // and numbers of rows that their lists hold: half a GB each
  static constexpr std::size_t kMostHeld = 125'000'000;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;
  /// Rows of which a cone's directions do not agree whether they go, and what they agree on.
  struct Rows {
    std::vector<int> free;
    int removals;  // how many of the free ones go
    Small kept;    // sum of c c' of those that stay
    Small most;    // and of the free ones, too
  };
  struct Cone {
    Small V;  // unit edges
    double lower;
    std::shared_ptr<const Rows> rows;
    bool operator<(const Cone& other) const { return lower > other.lower; }  // the lowest first in a heap
  };

  /// Sum of c c' over these rows.
  Small outer(const std::vector<int>& rows) {
    const Eigen::Index n = C_.cols();
    Small S(n, n);
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = a; b < n; ++b) {
        for (std::size_t i = 0; i < rows.size(); ++i)
          values_(static_cast<Eigen::Index>(i)) = C_(rows[i], a) * C_(rows[i], b);
        S(a, b) = S(b, a) = sum(values_.data(), static_cast<std::ptrdiff_t>(rows.size()));
      }
    return S;
  }

  /// Remove the rows most aligned with u, turn to the weakest direction of the rest, and so on.
  void improve(Column u) {
    for (int step = 0; step < 20; ++step) {
      work_ += static_cast<double>(C_.rows());
      const Vector aligned = (C_ * u).cwiseAbs();
      values_ = aligned;
      const auto last = values_.data() + s_;  // the least that goes is before it
      std::nth_element(values_.data(), last, values_.data() + values_.size(), std::greater<>());
      const double edge = *last;
      int ties = s_ - static_cast<int>((aligned.array() > edge).count());
      std::vector<int> removed, kept;
      for (int i = 0; i < static_cast<int>(aligned.size()); ++i) {
        const bool goes = aligned(i) > edge || (aligned(i) == edge && ties-- > 0);
        (goes ? removed : kept).push_back(i);
      }
      const Small S = outer(kept);
      Column values(S.cols());
      Small vectors(S.rows(), S.cols());
      symmetric_eigen(S.data(), S.cols(), values.data(), vectors.data());
      const double value = std::max(values(0), 0.0);
      if (!(value < best_.upper)) return;
      best_.upper = value;
      best_.removed = std::move(removed);
      u = vectors.col(0);
    }
  }

  std::shared_ptr<const Rows> hold(Rows&& rows) {
    held_ += rows.free.size();
    return {new Rows(std::move(rows)), [this](const Rows* gone) {
              held_ -= gone->free.size();
              delete gone;
            }};
  }

  bool out_of_budget() {
    constexpr double kOften = 65536.0;  // rows looked at between two questions, less than a millisecond
    if (work_ >= most_ || open_.size() >= kMostCones) return true;
    if (work_ < asked_ + kOften) return false;
    asked_ = work_;
    return budget_.over();
  }

  /// The rows that are looked at next.
  void gather(const Rows& rows) {
    const auto m = static_cast<Eigen::Index>(rows.free.size());
    c_.resize(m, C_.cols());
    for (Eigen::Index a = 0; a < C_.cols(); ++a)
      for (Eigen::Index i = 0; i < m; ++i) c_(i, a) = C_(rows.free[static_cast<std::size_t>(i)], a);
  }

  /// Bound of a cone; it is open as long as that is below the best. The rows have been gathered.
  void look(const Small& V, const std::shared_ptr<const Rows>& rows) {
    const Eigen::Index n = V.cols();
    const Eigen::Index m = c_.rows();
    const Eigen::Index staying = m - rows->removals;
    ++best_.nodes;
    work_ += static_cast<double>(m) + 256.0;
    const Matrix p = c_ * V;
    Small Q = V.transpose() * rows->kept * V;
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index k = j; k < n; ++k) {
        values_.head(m) = p.col(j).cwiseProduct(p.col(k));
        if (staying < m) std::nth_element(values_.data(), values_.data() + staying, values_.data() + m);
        Q(j, k) += sum(values_.data(), staying);
        Q(k, j) = Q(j, k);
      }
    for (Eigen::Index j = 0; j < n; ++j)
      if (Q(j, j) < best_.upper - margin_) improve(V.col(j));
    Small G = V.transpose() * V;
    G.diagonal().setOnes();
    const double lower = least_ratio(Q, G.cwiseMax(0.0));
    if (lower >= best_.upper - margin_) return;
    open_.push_back({V, lower, rows});
    std::push_heap(open_.begin(), open_.end());
  }

  /// Two halves of the lowest cone.
  void split() {
    std::pop_heap(open_.begin(), open_.end());
    const Cone cone = std::move(open_.back());
    open_.pop_back();
    const auto rows = narrowed(cone);
    Eigen::Index a = 0, b = 0;  // the two edges whose rows differ most: cones are as flat as valleys are
    double width = -1.0;
    for (Eigen::Index j = 0; j < cone.V.cols(); ++j)
      for (Eigen::Index k = j + 1; k < cone.V.cols(); ++k) {
        const Column across = cone.V.col(j) - cone.V.col(k);
        const double apart = across.dot(rows->most * across);
        if (apart <= width) continue;
        width = apart;
        a = j;
        b = k;
      }
    const Column middle = (cone.V.col(a) + cone.V.col(b)).normalized();
    for (const Eigen::Index edge : {a, b}) {
      Small V = cone.V;
      V.col(edge) = middle;
      look(V, rows);
    }
  }

  /// c'Mc is linear in M: where s rows have more in the whole cone than a row has anywhere in it, that row
  /// stays; where at most s have more anywhere than it has everywhere, it goes. Gathers what is left.
  std::shared_ptr<const Rows> narrowed(const Cone& cone) {
    const Rows& rows = *cone.rows;
    gather(rows);
    const Eigen::Index m = c_.rows();
    work_ += static_cast<double>(m);
    const Matrix p = c_ * cone.V;
    Vector low = Vector::Constant(m, kInfinity);
    Vector high = Vector::Constant(m, -kInfinity);
    for (Eigen::Index j = 0; j < p.cols(); ++j)
      for (Eigen::Index k = j; k < p.cols(); ++k) {
        low = low.cwiseMin(p.col(j).cwiseProduct(p.col(k)));
        high = high.cwiseMax(p.col(j).cwiseProduct(p.col(k)));
      }
    const auto largest = [&](const Vector& of, int rank) {  // the rank-th, from 0 on
      values_.head(m) = of;
      std::nth_element(values_.data(), values_.data() + rank, values_.data() + m, std::greater<>());
      return values_(rank);
    };
    const double stays = rows.removals > 0 ? largest(low, rows.removals - 1) : kInfinity;
    const double goes = rows.removals < m ? largest(high, rows.removals) : -kInfinity;
    Rows fewer{{}, rows.removals, rows.kept, {}};
    std::vector<int> kept;
    for (Eigen::Index i = 0; i < m; ++i) {
      const int row = rows.free[static_cast<std::size_t>(i)];
      if (high(i) < stays)
        kept.push_back(row);
      else if (low(i) > goes)
        --fewer.removals;
      else
        fewer.free.push_back(row);
    }
    if (4 * fewer.free.size() > 3 * rows.free.size() || held_ + fewer.free.size() > kMostHeld)
      return cone.rows;
    fewer.kept += outer(kept);
    fewer.most = fewer.kept + outer(fewer.free);
    gather(fewer);
    return hold(std::move(fewer));
  }

  Matrix C_;
  int s_;
  double most_;  // rows looked at
  Budget budget_;
  double margin_ = 0.0;
  SubsetBound best_;
  std::size_t held_ = 0;    // rows that all lists hold
  std::vector<Cone> open_;  // a heap
  double work_ = 0.0;
  double asked_ = 0.0;
  Vector values_;
  Matrix c_;  // rows gathered
};

}  // namespace

SubsetBound lambda0_by_directions(const MatrixRef& C, int s, const SubsetLimits& limits) {
  return Directions(C, s, limits).run();
}

}  // namespace garrison::detail
