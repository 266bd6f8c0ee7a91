// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/matching.hpp"

#include <algorithm>

#include "phases.hpp"

namespace garrison::structure {
namespace {

constexpr int kRemoved = -2;
constexpr int kDead = -1;  // stamp of a column from which no augmenting path will ever start

Matching nothing_matched(const Pattern& pattern) {
  return {std::vector<int>(static_cast<std::size_t>(pattern.columns()), -1),
          std::vector<int>(static_cast<std::size_t>(pattern.rows()), -1), 0};
}

/// One search per column while that is cheap: on nearly full rank nothing is faster. Else from anew.
Matching from_columns(const Pattern& pattern) {
  const long long budget = pattern.entries();
  Augmenter search(pattern);
  for (int j = 0; j < pattern.columns(); ++j) {
    search.augment(j);
    if (search.work() > budget) return matching_by_phases(pattern);
  }
  return search.take();
}

}  // namespace

Augmenter::Augmenter(const Pattern& pattern, Matching start)
    : pattern_(&pattern),
      matching_(std::move(start)),
      free_from_(pattern.start(), pattern.start() + pattern.columns()),
      next_(free_from_.size()),
      stamp_(free_from_.size(), 0) {}

Augmenter::Augmenter(const Pattern& pattern) : Augmenter(pattern, nothing_matched(pattern)) {}

void Augmenter::remove_row(int row) {
  int& column = matching_.column_of[static_cast<std::size_t>(row)];
  if (column >= 0) {
    matching_.row_of[static_cast<std::size_t>(column)] = -1;
    --matching_.size;
  }
  column = kRemoved;
}

bool Augmenter::augment(int column) {
  const int* const start = pattern_->start();
  const int* const index = pattern_->index();
  int* const row_of = matching_.row_of.data();
  int* const column_of = matching_.column_of.data();
  int* const free_from = free_from_.data();
  int* const next = next_.data();
  int* const stamp = stamp_.data();
  // Lookahead: a row that is still free. Matched rows never become free again, so each entry is passed once.
  const auto free_row = [&](int j) {
    const int end = start[j + 1];
    int& p = free_from[j];
    while (p < end) {
      const int row = index[p++];
      if (column_of[row] == -1) return row;
    }
    return -1;
  };
  const int at_once = free_row(column);
  if (at_once >= 0) {
    row_of[column] = at_once;
    column_of[at_once] = column;
    ++matching_.size;
    return true;
  }
  ++search_;
  path_.assign(1, column);
  visited_.assign(1, column);
  stamp[column] = search_;
  next[column] = start[column];
  while (!path_.empty()) {
    const int j = path_.back();
    const int end = start[j + 1];
    int child = -1;
    int p = next[j];
    const int first = p;
    for (; p < end; ++p) {
      const int other = column_of[index[p]];
      // Dead columns and those of this search are left out; both stamps differ from older searches'.
      if (other >= 0 && stamp[other] != search_ && stamp[other] != kDead) {
        child = other;
        ++p;
        break;
      }
    }
    work_ += p - first + 1;
    next[j] = p;
    if (child < 0) {
      path_.pop_back();
      continue;
    }
    stamp[child] = search_;
    next[child] = start[child];
    path_.push_back(child);
    visited_.push_back(child);
    int row = free_row(child);
    if (row < 0) continue;
    // Shift the path: each of its columns takes the row it found, the column before it the one given up.
    for (auto at = path_.rbegin(); at != path_.rend(); ++at) {
      const int given_up = row_of[*at];
      row_of[*at] = row;
      column_of[row] = *at;
      row = given_up;
    }
    ++matching_.size;
    return true;
  }
  // What a failed search reached can be left out of all later ones: it has no free row and never will.
  for (const int j : visited_) stamp[j] = kDead;
  return false;
}

Matching maximum_matching(const Pattern& pattern) {
  // From the side with fewer vertices that have an entry: searches that must fail are what costs.
  std::vector<char> used(static_cast<std::size_t>(pattern.rows()), 0);
  for (int p = 0; p < pattern.entries(); ++p) used[static_cast<std::size_t>(pattern.index()[p])] = 1;
  const auto rows = std::count(used.begin(), used.end(), 1);
  int columns = 0;
  for (int j = 0; j < pattern.columns(); ++j) columns += pattern.start()[j + 1] > pattern.start()[j] ? 1 : 0;
  if (rows < columns) {
    Matching m = from_columns(pattern.transposed());
    std::swap(m.row_of, m.column_of);
    return m;
  }
  return from_columns(pattern);
}

Matching maximum_matching(const Pattern& pattern, std::span<const int> last) {
  std::vector<char> late(static_cast<std::size_t>(pattern.columns()), 0);
  for (const int j : last) late[static_cast<std::size_t>(j)] = 1;
  Augmenter search(pattern);
  for (int j = 0; j < pattern.columns(); ++j)
    if (late[static_cast<std::size_t>(j)] == 0) search.augment(j);
  for (const int j : last)
    if (search.matching().row_of[static_cast<std::size_t>(j)] < 0) search.augment(j);
  return search.take();
}

}  // namespace garrison::structure
