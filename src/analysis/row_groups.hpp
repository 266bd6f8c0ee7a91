// SPDX-License-Identifier: Apache-2.0
// Rows that are equal up to sign: only how many of them are removed matters. Internal.
#pragma once

#include <algorithm>
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
  if (!C.allFinite()) refuse(std::string(who) + ".C", "a number that is not finite", "finite rows");
  if (s < 0 || s > C.rows())
    refuse(std::string(who) + ".s", std::to_string(s), "a number in 0.." + std::to_string(C.rows()),
           "s counts removed rows");
}

inline RowGroups group_rows(const MatrixRef& C) {
  constexpr double kSame = 1e-14;
  RowGroups g;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    const double scale = kSame * (1.0 + C.row(i).norm());
    std::size_t k = 0;
    for (; k < g.members.size(); ++k) {
      const auto first = g.members[k].front();
      if ((C.row(first) - C.row(i)).norm() <= scale || (C.row(first) + C.row(i)).norm() <= scale) break;
    }
    if (k == g.members.size()) g.members.emplace_back();
    g.members[k].push_back(static_cast<int>(i));
    g.group.push_back(static_cast<int>(k));
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
