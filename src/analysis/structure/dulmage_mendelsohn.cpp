// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/dulmage_mendelsohn.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "garrison/analysis/structure/components.hpp"
#include "sides.hpp"

namespace garrison::structure {
namespace {

enum Part : char { square = 0, horizontal = 1, vertical = 2 };

/// Breadth-first from the unmatched vertices of one side: `reached` lists that side's vertices, `across` the
/// other side's that are matched to them. `lists`: neighbours of a vertex; `partner_across`: its matches.
struct Reached {
  std::vector<int> side;
  std::vector<int> across;
};

Reached reach(const Pattern& lists, const std::vector<int>& partner, const std::vector<int>& partner_across) {
  Reached out;
  out.side.reserve(partner.size());
  out.across.reserve(partner.size());
  for (std::size_t v = 0; v < partner.size(); ++v)
    if (partner[v] < 0) out.side.push_back(static_cast<int>(v));
  // Marked are the vertices across: most entries lead to one that has been seen, and end there.
  std::vector<char> marks(partner_across.size(), 0);
  char* const seen = marks.data();
  const int* start = lists.start();
  const int* index = lists.index();
  for (std::size_t k = 0; k < out.side.size(); ++k) {
    const int v = out.side[k];
    for (int p = start[v]; p < start[v + 1]; ++p) {
      if (std::exchange(seen[index[p]], 1) != 0) continue;
      const int back = partner_across[static_cast<std::size_t>(index[p])];
      if (back < 0) continue;
      out.side.push_back(back);
      out.across.push_back(index[p]);
    }
  }
  return out;
}

/// Strong components of the square part, a vertex being a column with its matched row.
void fine_blocks(const Pattern& pattern, const std::vector<char>& part, Decomposition& d) {
  const int* const row_of = d.matching.row_of.data();
  std::vector<int> vertex(static_cast<std::size_t>(pattern.rows()), -1);  // of each row
  std::vector<int> columns;
  columns.reserve(static_cast<std::size_t>(d.matching.size));
  for (int j = 0; j < pattern.columns(); ++j)
    if (part[static_cast<std::size_t>(j)] == square) {
      vertex[static_cast<std::size_t>(row_of[j])] = static_cast<int>(columns.size());
      columns.push_back(j);
    }
  std::vector<int> start{0};
  std::vector<int> index;
  start.reserve(columns.size() + 1);
  index.reserve(static_cast<std::size_t>(pattern.entries()));
  for (const int j : columns) {
    for (const int i : pattern.column(j))
      if (vertex[static_cast<std::size_t>(i)] >= 0) index.push_back(vertex[static_cast<std::size_t>(i)]);
    start.push_back(static_cast<int>(index.size()));
  }
  const auto components =
      strong_components(Pattern(static_cast<int>(columns.size()), std::move(start), std::move(index)));
  d.block_start.assign(static_cast<std::size_t>(components.count) + 1, 0);
  for (const int c : components.of) ++d.block_start[static_cast<std::size_t>(c) + 1];
  std::partial_sum(d.block_start.begin(), d.block_start.end(), d.block_start.begin());
  std::vector<int> next(d.block_start.begin(), d.block_start.end() - 1);
  d.sq_cols.resize(columns.size());
  d.sq_rows.resize(columns.size());
  for (std::size_t v = 0; v < columns.size(); ++v) {
    const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(components.of[v])]++);
    d.sq_cols[at] = columns[v];
    d.sq_rows[at] = row_of[columns[v]];
  }
}

Decomposition decompose(Sides& sides, Matching matching) {
  const Pattern& pattern = sides.columns();
  Decomposition d;
  d.matching = std::move(matching);
  std::vector<char> part(static_cast<std::size_t>(pattern.columns()), square);
  if (d.matching.size < pattern.columns()) {
    auto from_columns = reach(pattern, d.matching.row_of, d.matching.column_of);
    d.hor_cols = std::move(from_columns.side);
    d.hor_rows = std::move(from_columns.across);
    for (const int j : d.hor_cols) part[static_cast<std::size_t>(j)] = horizontal;
  }
  if (d.matching.size < pattern.rows()) {
    auto from_rows = reach(sides.rows(), d.matching.column_of, d.matching.row_of);
    d.ver_rows = std::move(from_rows.side);
    d.ver_cols = std::move(from_rows.across);
    for (const int j : d.ver_cols) part[static_cast<std::size_t>(j)] = vertical;
  }
  fine_blocks(pattern, part, d);
  return d;
}

}  // namespace

Decomposition dulmage_mendelsohn(const Pattern& pattern) {
  Sides sides(pattern);
  Matching matching = maximum_matching(sides);
  return decompose(sides, std::move(matching));
}

Decomposition dulmage_mendelsohn(const Pattern& pattern, Matching matching) {
  Sides sides(pattern);
  return decompose(sides, std::move(matching));
}

std::vector<int> reachable_columns(const Pattern& pattern, const Matching& matching,
                                   std::span<const int> from) {
  std::vector<char> seen(static_cast<std::size_t>(pattern.columns()), 0);
  std::vector<int> reached;
  for (const int j : from)
    if (std::exchange(seen[static_cast<std::size_t>(j)], 1) == 0) reached.push_back(j);
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const int i : pattern.column(reached[k])) {
      const int other = matching.column_of[static_cast<std::size_t>(i)];
      if (other >= 0 && std::exchange(seen[static_cast<std::size_t>(other)], 1) == 0)
        reached.push_back(other);
    }
  return reached;
}

std::vector<std::vector<int>> contraction_components(const Pattern& pattern, const Decomposition& parts) {
  // Every row of the horizontal part is matched to one of its columns, so two columns that share a row lie in
  // overlapping contractions: the components are those of the part as a bipartite graph.
  std::vector<int> root(static_cast<std::size_t>(pattern.columns()));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int j) {
    while (root[static_cast<std::size_t>(j)] != j) {
      int& above = root[static_cast<std::size_t>(j)];
      above = root[static_cast<std::size_t>(above)];
      j = above;
    }
    return j;
  };
  for (const int j : parts.hor_cols)
    for (const int i : pattern.column(j)) {
      const int a = find(j);
      const int b = find(parts.matching.column_of[static_cast<std::size_t>(i)]);
      root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  std::vector<int> sorted = parts.hor_cols;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::vector<int>> all;
  std::vector<int> place(root.size(), -1);
  for (const int j : sorted) {
    int& at = place[static_cast<std::size_t>(find(j))];
    if (at < 0) {
      at = static_cast<int>(all.size());
      all.emplace_back();
    }
    all[static_cast<std::size_t>(at)].push_back(j);
  }
  return all;
}

}  // namespace garrison::structure
