// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/pattern.hpp"

#include <algorithm>
#include <cmath>

namespace garrison::structure {
namespace {

void require_sizes(int rows, int columns) {
  if (rows < 0 || columns < 0)
    refuse("pattern", std::to_string(rows) + " x " + std::to_string(columns), "sizes >= 0");
}

}  // namespace

Pattern::Pattern(int rows, int columns, std::span<const std::pair<int, int>> entries)
    : rows_(rows), start_(static_cast<std::size_t>(std::max(columns, 0)) + 1, 0) {
  require_sizes(rows, columns);
  for (const auto& [j, i] : entries) {
    if (j < 0 || j >= columns || i < 0 || i >= rows)
      refuse(
          "edge",
          std::string("(").append(std::to_string(j)).append(", ").append(std::to_string(i)).append(")"),
          "a column in 0.." + std::to_string(columns - 1) + " and a row in 0.." + std::to_string(rows - 1));
    ++start_[static_cast<std::size_t>(j) + 1];
  }
  for (std::size_t j = 1; j < start_.size(); ++j) start_[j] += start_[j - 1];
  index_.resize(entries.size());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (const auto& [j, i] : entries)
    index_[static_cast<std::size_t>(next[static_cast<std::size_t>(j)]++)] = i;
  // Each column sorted and without doubles.
  int kept = 0;
  for (int j = 0; j < columns; ++j) {
    const auto begin = index_.begin() + start_[static_cast<std::size_t>(j)];
    const auto end = index_.begin() + start_[static_cast<std::size_t>(j) + 1];
    std::sort(begin, end);
    const auto last = std::unique(begin, end);
    start_[static_cast<std::size_t>(j)] = kept;
    for (auto it = begin; it != last; ++it) index_[static_cast<std::size_t>(kept++)] = *it;
  }
  start_.back() = kept;
  index_.resize(static_cast<std::size_t>(kept));
}

Pattern::Pattern(int rows, std::vector<int> start, std::vector<int> index)
    : rows_(rows), start_(std::move(start)), index_(std::move(index)) {
  require_sizes(rows, static_cast<int>(start_.size()) - 1);
  if (start_.front() != 0 || static_cast<std::size_t>(start_.back()) != index_.size() ||
      !std::is_sorted(start_.begin(), start_.end()))
    refuse("pattern", "column starts that do not fit the entries",
           "starts that begin with 0, never fall and end with the number of entries");
  for (const int i : index_)
    if (i < 0 || i >= rows) refuse("pattern", "row " + std::to_string(i), "0.." + std::to_string(rows - 1));
}

Pattern Pattern::of(const MatrixRef& M, double tolerance) {
  if (!(tolerance >= 0.0)) refuse("tolerance", text(tolerance), "a number >= 0");
  std::vector<int> start{0};
  std::vector<int> index;
  for (Eigen::Index j = 0; j < M.cols(); ++j) {
    for (Eigen::Index i = 0; i < M.rows(); ++i) {
      if (!std::isfinite(M(i, j)))
        refuse("pattern[" + std::to_string(i) + ", " + std::to_string(j) + "]", text(M(i, j)),
               "a finite number");
      if (std::abs(M(i, j)) > tolerance) index.push_back(static_cast<int>(i));
    }
    start.push_back(static_cast<int>(index.size()));
  }
  return {static_cast<int>(M.rows()), std::move(start), std::move(index)};
}

Pattern Pattern::transposed() const {
  Pattern t;
  t.rows_ = columns();
  t.start_.assign(static_cast<std::size_t>(rows_) + 2, 0);
  t.index_.resize(index_.size());
  // Counted two places further on: after the sums place[i + 1] is the start of row i, and has become that of
  // row i + 1 when all its entries are in place.
  int* const place = t.start_.data();
  int* const out = t.index_.data();
  for (const int i : index_) ++place[i + 2];
  for (int i = 1; i <= rows_; ++i) place[i + 1] += place[i];
  for (int j = 0; j < columns(); ++j)
    for (int p = start()[j]; p < start()[j + 1]; ++p) out[place[index()[p] + 1]++] = j;
  t.start_.pop_back();
  return t;
}

Pattern Pattern::stacked(std::span<const std::vector<int>> below) const {
  std::vector<std::pair<int, int>> all;
  all.reserve(index_.size());
  for (int j = 0; j < columns(); ++j)
    for (const int i : column(j)) all.emplace_back(j, i);
  int row = rows_;
  for (const auto& list : below) {
    for (const int j : list) {
      if (j < 0 || j >= columns())
        refuse("measured state", std::to_string(j), "a state in 0.." + std::to_string(columns() - 1));
      all.emplace_back(j, row);
    }
    ++row;
  }
  return {row, columns(), all};
}

}  // namespace garrison::structure
