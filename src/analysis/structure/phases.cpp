// SPDX-License-Identifier: Apache-2.0
#include "phases.hpp"

#include <memory>

namespace garrison::structure {
namespace {

using Ints = std::unique_ptr<int[]>;

Ints ints(int count) { return std::make_unique_for_overwrite<int[]>(static_cast<std::size_t>(count) + 1); }

/// Fills `m` by Karp and Sipser's rules.
void karp_sipser(const Pattern& columns, const Pattern& rows, Matching& m) {
  const int n = columns.columns();
  const int* const cs = columns.start();
  const int* const ci = columns.index();
  const int* const rs = rows.start();
  const int* const ri = rows.index();
  int* const row_of = m.row_of.data();
  int* const column_of = m.column_of.data();
  // Free neighbours left of each row and column; vertices with one wait on a stack (rows as ~row).
  const Ints row_degree = ints(columns.rows());
  const Ints column_degree = ints(n);
  const Ints waiting = ints(n + columns.rows());
  int waits = 0;
  for (int i = 0; i < columns.rows(); ++i) {
    row_degree[static_cast<std::size_t>(i)] = rs[i + 1] - rs[i];
    if (row_degree[static_cast<std::size_t>(i)] == 1) waiting[static_cast<std::size_t>(waits++)] = ~i;
  }
  for (int j = 0; j < n; ++j) {
    column_degree[static_cast<std::size_t>(j)] = cs[j + 1] - cs[j];
    if (column_degree[static_cast<std::size_t>(j)] == 1) waiting[static_cast<std::size_t>(waits++)] = j;
  }
  int* const rd = row_degree.get();
  int* const cd = column_degree.get();
  int* const wait = waiting.get();
  const auto match = [&](int j, int i) {
    row_of[j] = i;
    column_of[i] = j;
    ++m.size;
    for (int p = rs[i]; p < rs[i + 1]; ++p)
      if (--cd[ri[p]] == 1 && row_of[ri[p]] < 0) wait[waits++] = ri[p];
    for (int p = cs[j]; p < cs[j + 1]; ++p)
      if (--rd[ci[p]] == 1 && column_of[ci[p]] < 0) wait[waits++] = ~ci[p];
  };
  const auto settle = [&] {
    while (waits > 0) {
      const int v = wait[--waits];
      if (v >= 0) {
        if (row_of[v] >= 0) continue;
        for (int p = cs[v]; p < cs[v + 1]; ++p)
          if (column_of[ci[p]] < 0) {
            match(v, ci[p]);
            break;
          }
      } else {
        const int i = ~v;
        if (column_of[i] >= 0) continue;
        for (int p = rs[i]; p < rs[i + 1]; ++p)
          if (row_of[ri[p]] < 0) {
            match(ri[p], i);
            break;
          }
      }
    }
  };
  settle();
  for (int j = 0; j < n; ++j) {
    if (row_of[j] >= 0) continue;
    int best = -1;
    for (int p = cs[j]; p < cs[j + 1]; ++p)
      if (column_of[ci[p]] < 0 && (best < 0 || rd[ci[p]] < rd[best])) best = ci[p];
    if (best < 0) continue;
    match(j, best);
    settle();
  }
}

/// Augmenting paths that share no column within a phase.
void phases(const Pattern& pattern, Matching& m) {
  const int n = pattern.columns();
  const int* const start = pattern.start();
  const int* const index = pattern.index();
  int* const row_of = m.row_of.data();
  int* const column_of = m.column_of.data();
  const Ints ahead = ints(n);
  const Ints next = ints(n);
  const Ints path = ints(n);
  std::vector<int> stamp(static_cast<std::size_t>(n), 0);
  int* const seen = stamp.data();
  for (int j = 0; j < n; ++j) ahead[static_cast<std::size_t>(j)] = start[j];
  std::vector<int> open;
  for (int j = 0; j < n; ++j)
    if (row_of[j] < 0 && start[j] < start[j + 1]) open.push_back(j);
  std::vector<int> visited;
  constexpr int kDead = -1;
  for (int phase = 1; !open.empty(); ++phase) {
    std::size_t left = 0;
    bool any = false;
    const bool forwards = phase % 2 == 1;
    for (const int root : open) {
      int depth = 0;
      path[0] = root;
      seen[root] = phase;
      next[static_cast<std::size_t>(root)] = forwards ? start[root] : start[root + 1] - 1;
      visited.assign(1, root);
      int row = -1;
      while (depth >= 0) {
        const int j = path[static_cast<std::size_t>(depth)];
        const int end = start[j + 1];
        int& a = ahead[static_cast<std::size_t>(j)];
        while (a < end && row < 0) {
          if (column_of[index[a]] < 0) row = index[a];
          ++a;
        }
        if (row >= 0) break;
        int child = -1;
        int& p = next[static_cast<std::size_t>(j)];
        if (forwards) {
          while (p < end && child < 0) {
            const int other = column_of[index[p++]];
            if (seen[other] != phase && seen[other] != kDead) child = other;
          }
        } else {
          while (p >= start[j] && child < 0) {
            const int other = column_of[index[p--]];
            if (seen[other] != phase && seen[other] != kDead) child = other;
          }
        }
        if (child < 0) {
          --depth;
          continue;
        }
        seen[child] = phase;
        next[static_cast<std::size_t>(child)] = forwards ? start[child] : start[child + 1] - 1;
        if (!any) visited.push_back(child);
        path[static_cast<std::size_t>(++depth)] = child;
      }
      if (row >= 0) {
        any = true;
        ++m.size;
        for (; depth >= 0; --depth) {
          const int j = path[static_cast<std::size_t>(depth)];
          const int given_up = row_of[j];
          row_of[j] = row;
          column_of[row] = j;
          row = given_up;
        }
      } else if (any) {
        open[left++] = root;
      } else {
        for (const int j : visited) seen[j] = kDead;
      }
    }
    open.resize(left);
    if (!any) break;
  }
}

}  // namespace

Matching matching_by_phases(const Pattern& columns, const Pattern& rows) {
  Matching m{std::vector<int>(static_cast<std::size_t>(columns.columns()), -1),
             std::vector<int>(static_cast<std::size_t>(columns.rows()), -1), 0};
  karp_sipser(columns, rows, m);
  phases(columns, m);
  return m;
}

}  // namespace garrison::structure
