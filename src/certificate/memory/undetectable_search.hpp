// SPDX-License-Identifier: Apache-2.0
// The search for the smallest set of meters whose readings an attacker can change unseen. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "dense.hpp"
#include "garrison/core/budget.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate::detail {

inline constexpr double kNear = 1e-9;       // of 1: rounding of a leverage
inline constexpr std::int64_t kPoll = 256;  // steps of the search between two looks at the clock

/// Depth-first search for sets of `size` rows of one part whose block of the hat matrix has eigenvalue 1.
class Search {
 public:
  /// Whether the rows of a set, by their numbers in the part, are needed to determine the state.
  using Needed = std::function<bool(const std::vector<int>&)>;

  /// rows: how those of the part are numbered; hat: the projector onto the part's range.
  Search(std::vector<Eigen::Index> rows, Matrix hat, Needed needed, double tries)
      : rows_(std::move(rows)), hat_(std::move(hat)), needed_(std::move(needed)), tries_(tries) {
    const auto m = rows_.size();
    partners_.resize(m);
    sums_.resize(m);
    for (std::size_t i = 0; i < m; ++i) {
      auto& p = partners_[i];
      p.resize(m);
      std::iota(p.begin(), p.end(), 0);
      p.erase(p.begin() + static_cast<std::ptrdiff_t>(i));
      std::stable_sort(p.begin(), p.end(), [&](int a, int b) { return size(i, a) > size(i, b); });
      sums_[i].push_back(0.0);
      for (const int j : p) sums_[i].push_back(sums_[i].back() + size(i, j));
    }
  }

  /// A set, or empty; `complete` turns false when the tries are used up.
  std::vector<int> find(int count, bool& complete) {
    for (std::size_t i = 0; i < partners_.size(); ++i) {
      set_.assign(1, static_cast<int>(i));
      if (extend(i, 0, size(i, static_cast<int>(i)), count - 1, complete)) return numbered();
      if (!complete) break;
    }
    return {};
  }

 private:
  double size(std::size_t i, int j) const { return std::abs(hat_(static_cast<Eigen::Index>(i), j)); }

  std::vector<int> numbered() const {
    std::vector<int> out;
    for (const int k : set_) out.push_back(static_cast<int>(rows_[static_cast<std::size_t>(k)]));
    return out;
  }

  /// Row i of an eigenvector to 1 with the largest entry: sum over the set of |Lam_ij| >= 1.
  bool extend(std::size_t i, std::size_t from, double total, int need, bool& complete) {
    if (++steps_ % kPoll == 0 && current_budget().over()) complete = false;
    if (!complete) return false;
    if (need == 0) return judge(complete);
    const auto more = static_cast<std::size_t>(need);
    for (std::size_t q = from; q + more <= partners_[i].size(); ++q) {
      if (total + sums_[i][q + more] - sums_[i][q] < 1.0 - kNear) return false;  // partners only get weaker
      set_.push_back(partners_[i][q]);
      if (extend(i, q + 1, total + size(i, partners_[i][q]), need - 1, complete)) return true;
      set_.pop_back();
      if (!complete) return false;
    }
    return false;
  }

  bool judge(bool& complete) {
    complete = tries_-- > 0.0;
    if (!complete) return false;
    const auto k = static_cast<Eigen::Index>(set_.size());
    Matrix block(k, k);
    for (Eigen::Index a = 0; a < k; ++a)
      for (Eigen::Index b = 0; b < k; ++b)
        block(a, b) = hat_(set_[static_cast<std::size_t>(a)], set_[static_cast<std::size_t>(b)]);
    Matrix room(k, 3);
    if (!(extreme_eigenvalues(block, room).second > 1.0 - kNear)) return false;
    // 1 - eigenvalue is the square of the smallest singular value that is left: ask the rows themselves.
    return needed_(set_);
  }

  std::vector<Eigen::Index> rows_;
  Matrix hat_;
  Needed needed_;
  double tries_;
  std::int64_t steps_ = 0;
  std::vector<std::vector<int>> partners_;
  std::vector<std::vector<double>> sums_;
  std::vector<int> set_;
};

}  // namespace garrison::certificate::detail
