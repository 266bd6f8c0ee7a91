// SPDX-License-Identifier: Apache-2.0
// Exact lambda_0 by branch and bound with leverage pruning. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "garrison/analysis/subsets.hpp"
#include "garrison/core/budget.hpp"
#include "row_groups.hpp"
#include "symmetric_eigen.hpp"

namespace garrison::detail {

/// Decides rows one by one. A node has the sum S of all rows not removed, r rows still to remove, and the
/// rows that may be. With B = S - best I > 0, removing the rows V leaves lambda_min > best exactly if V'B^-1V
/// < I; its trace, the sum of the leverages c'B^-1c, is at most that of the r largest. Below 1, the node is
/// closed.
template <int n>
class BranchAndBound {
 public:
  BranchAndBound(const MatrixRef& C, int s, const SubsetLimits& limits)
      : C_(C.transpose()),
        s_(s),
        max_nodes_(limits.max_nodes),
        budget_(current_budget().within(limits.max_seconds)),
        groups_(group_rows(C)) {}

  SubsetBound run() {
    Square S = Square::Zero(C_.rows(), C_.rows());
    for (Eigen::Index i = 0; i < C_.cols(); ++i) S += C_.col(i) * C_.col(i).transpose();
    scale_ = std::max(S.trace(), 1e-300);
    best_ = kInfinity;
    heuristic(S);
    std::vector<int> candidates(static_cast<std::size_t>(C_.cols()));
    std::iota(candidates.begin(), candidates.end(), 0);
    open_ = kInfinity;
    root_ = certify(S, s_, candidates);
    // A search keeps the candidates of every depth.
    stopped_ = static_cast<double>(s_) * static_cast<double>(C_.cols()) > kMostMemory;
    levels_.resize(static_cast<std::size_t>(stopped_ ? 0 : s_) + 1);
    search(S, s_, candidates);
    SubsetBound b;
    b.upper = std::max(best_, 0.0);
    b.exact = !stopped_;
    b.lower = std::max(0.0, std::min(target(), open_));
    b.removed = best_set_;
    std::sort(b.removed.begin(), b.removed.end());
    b.nodes = nodes_;
    b.method = "branch and bound";
    return b;
  }

 private:
  static constexpr double kMostMemory = 2e7;      // entries of all depths together
  static constexpr std::size_t kMostStarts = 64;  // of the heuristic, besides the eigenvectors
  using Square = Mat<n>;
  using Column = Vec<n>;
  using Columns = Eigen::Matrix<double, n, Eigen::Dynamic>;
  struct Level {  // scratch of one depth, so that the search allocates only once per depth
    std::vector<double> leverage;
    std::vector<int> order;
    std::vector<int> rest;
  };

  /// Sets worse than this by rounding only are not looked for; the certificate is this number.
  double target() const { return best_ - kRounding * scale_; }

  static double least(const Square& S, Column* direction = nullptr) {
    Column values(S.cols());
    if (direction == nullptr) {
      symmetric_eigen(S.data(), S.cols(), values.data());
    } else {
      Square vectors(S.rows(), S.cols());
      symmetric_eigen(S.data(), S.cols(), values.data(), vectors.data());
      *direction = vectors.col(0);
    }
    return values(0);
  }

  void offer(double value, const std::vector<int>& removed) {
    if (value >= best_) return;
    best_ = value;
    best_set_ = removed;
  }

  /// From each start direction: remove the rows most aligned with it, turn to the weakest direction of the
  /// rest.
  void heuristic(const Square& S) {
    Column values(S.cols());
    Square vectors(S.rows(), S.cols());
    symmetric_eigen(S.data(), S.cols(), values.data(), vectors.data());
    for (Eigen::Index k = 0; k < vectors.cols(); ++k) improve(S, vectors.col(k), {}, s_);
    const std::size_t G = groups_.members.size();
    const std::size_t starts = std::min(G, kMostStarts);
    for (std::size_t k = 0; k < starts && !budget_.over(); ++k) {
      const Column c = C_.col(groups_.members[k * G / starts].front());
      if (c.norm() > 0.0) improve(S, c.normalized(), {}, s_);
    }
  }

  /// Completes `removed` (already taken out of S) by r more rows.
  void improve(const Square& S, Column u, const std::vector<int>& removed, int r) {
    std::vector<int> order;
    for (Eigen::Index i = 0; i < C_.cols(); ++i)
      if (std::find(removed.begin(), removed.end(), static_cast<int>(i)) == removed.end())
        order.push_back(static_cast<int>(i));
    double last = kInfinity;
    for (int step = 0; step < 20; ++step) {
      std::partial_sort(order.begin(), order.begin() + r, order.end(), [&](int a, int b) {
        return std::abs(C_.col(a).dot(u)) > std::abs(C_.col(b).dot(u));
      });
      Square rest = S;
      std::vector<int> all = removed;
      for (int k = 0; k < r; ++k) {
        const int i = order[static_cast<std::size_t>(k)];
        rest -= C_.col(i) * C_.col(i).transpose();
        all.push_back(i);
      }
      const double value = least(rest, &u);
      offer(value, all);
      if (!(value < last - 1e-15 * scale_)) return;
      last = value;
    }
  }

  bool out_of_budget() {
    if (stopped_) return true;
    if (nodes_ >= max_nodes_) stopped_ = true;
    // A node costs about 10 ns per candidate and more: polled at least every millisecond.
    const std::int64_t often = std::max<std::int64_t>(1, 65536 / (C_.cols() + 256));
    if (nodes_ % often == 0 && budget_.over()) stopped_ = true;
    return stopped_;
  }

  /// B = L L' in place, in the lower triangle; false when B is not positive definite.
  static bool cholesky(Square& B) {
    for (Eigen::Index k = 0; k < B.cols(); ++k) {
      if (!(B(k, k) > 0.0)) return false;
      B(k, k) = std::sqrt(B(k, k));
      for (Eigen::Index i = k + 1; i < B.cols(); ++i) B(i, k) /= B(k, k);
      for (Eigen::Index j = k + 1; j < B.cols(); ++j)
        for (Eigen::Index i = j; i < B.cols(); ++i) B(i, j) -= B(i, k) * B(j, k);
    }
    return true;
  }

  /// Leverages of the candidates under S - level I; false when that is not positive definite.
  bool leverages(const Square& S, double level, const std::vector<int>& candidates,
                 std::vector<double>& out) const {
    Square L = S;
    L.diagonal().array() -= level;
    if (!cholesky(L)) return false;
    out.resize(candidates.size());
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      Column z = C_.col(candidates[k]);  // becomes L^-1 c
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        z(i) /= L(i, i);
        for (Eigen::Index j = i + 1; j < z.size(); ++j) z(j) -= L(j, i) * z(i);
      }
      out[k] = z.squaredNorm();
    }
    return true;
  }

  static double largest_sum(std::vector<double> values, int r) {
    const auto middle =
        values.begin() + std::min<std::ptrdiff_t>(r, static_cast<std::ptrdiff_t>(values.size()));
    std::partial_sort(values.begin(), middle, values.end(), std::greater<>());
    return std::accumulate(values.begin(), middle, 0.0);
  }

  /// A level that no completion of a node falls below.
  double certify(const Square& S, int r, const std::vector<int>& candidates) const {
    double low = 0.0;
    double high = std::min(target(), least(S));
    std::vector<double> leverage;
    for (int step = 0; step < 40 && high > low; ++step) {
      const double level = 0.5 * (low + high);
      const bool safe = leverages(S, level, candidates, leverage) && largest_sum(leverage, r) < 1.0;
      (safe ? low : high) = level;
    }
    return std::max(low, 0.0);
  }

  void search(const Square& S, int r, const std::vector<int>& candidates) {
    ++nodes_;
    if (r == 0) return offer(least(S), removed_);
    if (out_of_budget()) {
      open_ = std::min(open_, root_);  // holds for every set; to certify each open node would take for ever
      return;
    }
    Level& level = levels_[static_cast<std::size_t>(r)];
    while (!leverages(S, target(), candidates, level.leverage)) {
      // The rest is already at or below the best: any completion improves it.
      const double before = best_;
      Column u;
      least(S, &u);
      improve(S, u, removed_, r);
      if (best_ <= 0.0 || !(best_ < before)) break;
    }
    if (target() <= 0.0 || level.leverage.size() != candidates.size()) {
      if (least(S) <= std::max(target(), 0.0) + 1e-12 * scale_) {
        // Nothing lower exists than the rounding level of 0.
        Column u;
        least(S, &u);
        improve(S, u, removed_, r);
      }
      if (target() <= 0.0) return;
    }
    auto& order = level.order;
    order.resize(candidates.size());
    std::iota(order.begin(), order.end(), 0);
    const auto& leverage = level.leverage;
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      const double la = leverage[static_cast<std::size_t>(a)];
      const double lb = leverage[static_cast<std::size_t>(b)];
      return la != lb ? la > lb : group_of(candidates, a) < group_of(candidates, b);
    });
    int last_group = -1;
    for (std::size_t k = 0; k + static_cast<std::size_t>(r) <= order.size(); ++k) {
      double sum = 0.0;
      for (std::size_t j = k; j < k + static_cast<std::size_t>(r); ++j)
        sum += leverage[static_cast<std::size_t>(order[j])];
      if (sum < 1.0) return;  // also for all that follow
      const int row = candidates[static_cast<std::size_t>(order[k])];
      // A copy of a row that this level has already decided to keep would repeat the same sets.
      if (groups_.group[static_cast<std::size_t>(row)] == last_group) continue;
      last_group = groups_.group[static_cast<std::size_t>(row)];
      std::vector<int>& rest = level.rest;
      rest.clear();
      for (std::size_t j = k + 1; j < order.size(); ++j)
        rest.push_back(candidates[static_cast<std::size_t>(order[j])]);
      removed_.push_back(row);
      const Square without = S - C_.col(row) * C_.col(row).transpose();
      search(without, r - 1, rest);
      removed_.pop_back();
    }
  }

  int group_of(const std::vector<int>& candidates, int k) const {
    return groups_.group[static_cast<std::size_t>(candidates[static_cast<std::size_t>(k)])];
  }

  Columns C_;
  int s_;
  std::int64_t max_nodes_;
  Budget budget_;
  RowGroups groups_;
  double scale_ = 1.0;
  double best_ = kInfinity;
  double open_ = kInfinity;
  double root_ = 0.0;  // no set at all gets below this level
  bool stopped_ = false;
  std::int64_t nodes_ = 0;
  std::vector<int> removed_;
  std::vector<int> best_set_;
  std::vector<Level> levels_;
};

}  // namespace garrison::detail
