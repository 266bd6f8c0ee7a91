// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/matching.hpp"

namespace garrison::structure {
namespace {

constexpr int kFree = -1;
constexpr int kRemoved = -2;
constexpr int kDead = -1;  // stamp of a row whose column no augmenting path will ever pass

}  // namespace

Augmenter::Augmenter(const Pattern& pattern, Matching start)
    : index_(pattern.index()), matching_(std::move(start)) {
  columns_.reserve(static_cast<std::size_t>(pattern.columns()) + 1);
  for (int j = 0; j <= pattern.columns(); ++j) columns_.push_back({pattern.start()[j], pattern.start()[j]});
  rows_.reserve(matching_.column_of.size());
  for (const int column : matching_.column_of) rows_.push_back({column, 0});
}

Augmenter::Augmenter(const Pattern& pattern)
    : Augmenter(pattern, {std::vector<int>(static_cast<std::size_t>(pattern.columns()), -1),
                          std::vector<int>(static_cast<std::size_t>(pattern.rows()), kFree), 0}) {}

void Augmenter::remove_row(int row) {
  int& column = rows_[static_cast<std::size_t>(row)].column;
  if (column >= 0) {
    matching_.row_of[static_cast<std::size_t>(column)] = -1;
    --matching_.size;
  }
  column = kRemoved;
}

Matching Augmenter::take() {
  int* const column_of = matching_.column_of.data();
  for (std::size_t i = 0; i < rows_.size(); ++i) column_of[i] = rows_[i].column;
  return std::move(matching_);
}

/// A row that is still free. Matched rows never become free again, so each entry is passed once.
inline int Augmenter::free_row(int column) {
  const int* const index = index_;
  const Row* const rows = rows_.data();
  Column* const own = columns_.data() + column;
  const int end = own[1].start;
  int p = own->free_from;
  int found = -1;
  while (p < end && found < 0) {
    const int row = index[p++];
    if (rows[row].column == kFree) found = row;
  }
  own->free_from = p;
  return found;
}

bool Augmenter::matched_at_once(int column) {
  const int row = free_row(column);
  if (row < 0) return false;
  matching_.row_of[static_cast<std::size_t>(column)] = row;
  rows_[static_cast<std::size_t>(row)].column = column;
  ++matching_.size;
  return true;
}

/// Each column of the path takes the row it found, the column before it the one given up.
void Augmenter::shift_path(int row) {
  for (auto at = path_.rbegin(); at != path_.rend(); ++at) {
    matching_.row_of[static_cast<std::size_t>(at->column)] = row;
    rows_[static_cast<std::size_t>(row)].column = at->column;
    row = at->row;
  }
  ++matching_.size;
}

bool Augmenter::search(int column) {
  const int* const index = index_;
  const Column* const columns = columns_.data();
  Row* const rows = rows_.data();
  const int now = ++search_;
  passed_.clear();
  path_.clear();
  path_.push_back({column, -1, columns[column].start, columns[column + 1].start});
  while (!path_.empty()) {
    Step& top = path_.back();
    const int first = top.next;
    int p = first;
    int child = -1;
    int through = -1;
    while (p < top.end && child < 0) {
      through = index[p];
      Row& row = rows[through];
      // Dead rows and those of this search are left out; older searches' stamps differ from both.
      if (row.column >= 0 && row.stamp != now && row.stamp != kDead) {
        row.stamp = now;
        passed_.push_back(through);
        child = row.column;
      }
      ++p;
    }
    work_ += p - first + 1;
    top.next = p;
    if (child < 0) {
      path_.pop_back();
      continue;
    }
    path_.push_back({child, through, columns[child].start, columns[child + 1].start});
    const int row = free_row(child);
    if (row < 0) continue;
    shift_path(row);
    return true;
  }
  // What a failed search reached can be left out of all later ones: it has no free row and never will.
  for (const int row : passed_) rows[row].stamp = kDead;
  return false;
}

}  // namespace garrison::structure
