// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/matching.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "phases.hpp"
#include "sides.hpp"

namespace garrison::structure {
namespace {

Matching nothing_matched(const Pattern& pattern) {
  return {std::vector<int>(static_cast<std::size_t>(pattern.columns()), -1),
          std::vector<int>(static_cast<std::size_t>(pattern.rows()), -1), 0};
}

/// Nothing matched from the other side, in the memory of `m`.
Matching turned_and_cleared(Matching m) {
  std::swap(m.row_of, m.column_of);
  std::fill(m.row_of.begin(), m.row_of.end(), -1);
  std::fill(m.column_of.begin(), m.column_of.end(), -1);
  m.size = 0;
  return m;
}

/// Each column takes the first row that is free, until one finds none. Enough for a full diagonal, bands and
/// many more columns than rows or fewer.
Matching first_come(const Pattern& pattern) {
  Matching m = nothing_matched(pattern);
  const int* const start = pattern.start();
  const int* const index = pattern.index();
  int* const column_of = m.column_of.data();
  for (int j = 0; j < pattern.columns() && m.size < pattern.rows(); ++j) {
    const int end = start[j + 1];
    int p = start[j];
    if (p == end) continue;
    while (p < end && column_of[index[p]] >= 0) ++p;
    if (p == end) break;
    column_of[index[p]] = j;
    m.row_of[static_cast<std::size_t>(j)] = index[p];
    ++m.size;
  }
  return m;
}

/// One search per column while that is cheap: on nearly full rank nothing is faster. Else nothing.
std::optional<Matching> from_columns(const Pattern& pattern, Matching first) {
  // Patterns of nearly full rank need one or two looks per entry, deficient ones ten and more.
  const long long budget = 4LL * pattern.entries();
  const int* const start = pattern.start();
  Augmenter search(pattern, std::move(first));
  for (int j = 0; j < pattern.columns(); ++j) {
    if (start[j] == start[j + 1] || search.row_of(j) >= 0) continue;
    search.augment(j);
    if (search.work() > budget) return std::nullopt;
  }
  return search.take();
}

int used_columns(const Pattern& pattern) {
  const int* const start = pattern.start();
  int used = 0;
  for (int j = 0; j < pattern.columns(); ++j) used += start[j + 1] > start[j] ? 1 : 0;
  return used;
}

/// Whether fewer than `many` rows have an entry. Stops at the row that decides.
bool fewer_rows(const Pattern& pattern, int many) {
  const int* const index = pattern.index();
  std::vector<char> used(static_cast<std::size_t>(pattern.rows()), 0);
  for (int p = 0; p < pattern.entries() && many > 0; ++p)
    many -= std::exchange(used[static_cast<std::size_t>(index[p])], 1) == 0 ? 1 : 0;
  return many > 0;
}

}  // namespace

Matching maximum_matching(Sides& sides) {
  const Pattern& pattern = sides.columns();
  Matching first = first_come(pattern);
  if (first.size == pattern.rows()) return first;
  const int columns = used_columns(pattern);
  if (first.size == columns) return first;
  // From the side with fewer vertices that have an entry: searches that must fail are what costs. Where the
  // two sides hardly differ the transposition costs more.
  if (!fewer_rows(pattern, columns - columns / 1000)) {
    if (auto found = from_columns(pattern, std::move(first))) return *std::move(found);
    return matching_by_phases(pattern, sides.rows());
  }
  auto found = from_columns(sides.rows(), turned_and_cleared(std::move(first)));
  if (!found) found = matching_by_phases(sides.rows(), pattern);
  std::swap(found->row_of, found->column_of);
  return *std::move(found);
}

Matching maximum_matching(const Pattern& pattern) {
  Sides sides(pattern);
  return maximum_matching(sides);
}

Matching maximum_matching(const Pattern& pattern, std::span<const int> last) {
  std::vector<char> late(static_cast<std::size_t>(pattern.columns()), 0);
  for (const int j : last) late[static_cast<std::size_t>(j)] = 1;
  Augmenter search(pattern);
  for (int j = 0; j < pattern.columns(); ++j)
    if (late[static_cast<std::size_t>(j)] == 0) search.augment(j);
  for (const int j : last)
    if (search.row_of(j) < 0) search.augment(j);
  return search.take();
}

}  // namespace garrison::structure
