// SPDX-License-Identifier: Apache-2.0
// Random and adversarial patterns, and the slow definitions that fast answers are compared with.
#pragma once

#include <algorithm>
#include <vector>

#include "../../random_system.hpp"
#include "garrison/analysis/structure/matching.hpp"

namespace garrison::test {

using structure::Matching;
using structure::Pattern;

inline Pattern random_pattern(Rng& rng, int rows, int columns, int entries) {
  std::vector<std::pair<int, int>> all;
  for (int k = 0; k < entries && rows > 0 && columns > 0; ++k)
    all.emplace_back(whole(rng, 0, columns - 1), whole(rng, 0, rows - 1));
  return {rows, columns, all};
}

/// Kuhn's algorithm by recursion.
inline bool kuhn(const Pattern& p, int j, std::vector<int>& column_of, std::vector<char>& seen) {
  for (const int i : p.column(j)) {
    if (seen[static_cast<std::size_t>(i)] != 0) continue;
    seen[static_cast<std::size_t>(i)] = 1;
    int& other = column_of[static_cast<std::size_t>(i)];
    if (other >= 0 && !kuhn(p, other, column_of, seen)) continue;
    column_of[static_cast<std::size_t>(i)] = j;
    return true;
  }
  return false;
}
inline int kuhn_size(const Pattern& p) {
  std::vector<int> column_of(static_cast<std::size_t>(p.rows()), -1);
  int size = 0;
  for (int j = 0; j < p.columns(); ++j) {
    std::vector<char> seen(static_cast<std::size_t>(p.rows()), 0);
    size += kuhn(p, j, column_of, seen) ? 1 : 0;
  }
  return size;
}

/// Every match is an entry, both sides agree, and the size is right.
inline bool valid(const Pattern& p, const Matching& m) {
  int size = 0;
  for (int j = 0; j < p.columns(); ++j) {
    const int i = m.row_of[static_cast<std::size_t>(j)];
    if (i < 0) continue;
    ++size;
    const auto rows = p.column(j);
    if (std::find(rows.begin(), rows.end(), i) == rows.end()) return false;
    if (m.column_of[static_cast<std::size_t>(i)] != j) return false;
  }
  const auto matched = std::count_if(m.column_of.begin(), m.column_of.end(), [](int j) { return j >= 0; });
  return size == m.size && matched == size;
}

}  // namespace garrison::test
