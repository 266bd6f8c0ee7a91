// SPDX-License-Identifier: Apache-2.0
// Rows that are equal up to sign: only how many of them are removed matters. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::detail {

/// What sums and eigenvalues may be off by, relative to the trace; certificates err by it to the safe side.
inline constexpr double kRounding = 5e-15;

struct RowGroups {
  std::vector<int> group;                 // of each row
  std::vector<std::vector<int>> members;  // rows of each group
};

inline void require_subset_input(const char* who, const MatrixRef& C, int s) {
  if (C.rows() < 1 || C.cols() < 1)
    refuse(std::string(who) + ".C", std::to_string(C.rows()) + " x " + std::to_string(C.cols()),
           "at least 1 x 1");
  if (!C.allFinite() || C.cwiseAbs().maxCoeff() > kHuge)
    refuse(std::string(who) + ".C", "a number that is not finite, or beyond 1e150", "finite rows");
  if (s < 0 || s > C.rows())
    refuse(std::string(who) + ".s", std::to_string(s), "a number in 0.." + std::to_string(C.rows()),
           "s counts removed rows");
}

/// Rows are compared with those only that have the same |w c'| for a fixed w, so that equal ones meet after
/// sorting.
inline RowGroups group_rows(const MatrixRef& C) {
  constexpr double kSame = 1e-14;
  const Eigen::Index N = C.rows();
  const Vector w = Vector::NullaryExpr(
      C.cols(), [](Eigen::Index k) { return 1.0 + 0.5 * std::sin(1.0 + 2.4 * double(k)); });
  const Vector key = (C * w).cwiseAbs();
  const Vector scale = kSame * (1.0 + C.rowwise().norm().array());
  std::vector<Eigen::Index> order(static_cast<std::size_t>(N));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return key(a) < key(b); });
  const double reach = 4.0 * w.norm();
  std::vector<Eigen::Index> like(static_cast<std::size_t>(N));  // the first of its kind in the order of keys
  std::vector<Eigen::Index> kinds;                              // those whose key is near
  for (const Eigen::Index i : order) {
    std::erase_if(kinds,
                  [&](Eigen::Index k) { return key(i) - key(k) > reach * std::max(scale(i), scale(k)); });
    const auto same = std::find_if(kinds.begin(), kinds.end(), [&](Eigen::Index k) {
      const double near = std::min(scale(i), scale(k));
      return (C.row(k) - C.row(i)).norm() <= near || (C.row(k) + C.row(i)).norm() <= near;
    });
    like[static_cast<std::size_t>(i)] = same != kinds.end() ? *same : i;
    if (same == kinds.end()) kinds.push_back(i);
  }
  RowGroups g;
  std::vector<int> number(static_cast<std::size_t>(N), -1);  // of the group, in the order of rows
  for (Eigen::Index i = 0; i < N; ++i) {
    int& group = number[static_cast<std::size_t>(like[static_cast<std::size_t>(i)])];
    if (group < 0) {
      group = static_cast<int>(g.members.size());
      g.members.emplace_back();
    }
    g.members[static_cast<std::size_t>(group)].push_back(static_cast<int>(i));
    g.group.push_back(group);
  }
  return g;
}

/// Number of ways to remove s rows when rows of one group are interchangeable (saturates far beyond any
/// budget).
inline double removal_choices(const RowGroups& g, int s) {
  std::vector<double> ways(static_cast<std::size_t>(s) + 1, 0.0);
  ways[0] = 1.0;
  for (const auto& members : g.members) {
    std::vector<double> next(ways.size(), 0.0);
    for (std::size_t total = 0; total < ways.size(); ++total)
      for (std::size_t take = 0; take <= std::min(members.size(), total); ++take)
        next[total] += ways[total - take];
    ways = std::move(next);
  }
  return ways.back();
}

}  // namespace garrison::detail
