// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include <numeric>
#include <set>

#include "garrison/analysis/structure/components.hpp"
#include "garrison/analysis/structure/dulmage_mendelsohn.hpp"
#include "random_pattern.hpp"

using namespace garrison;
using namespace garrison::structure;

namespace {

std::set<int> set_of(const std::vector<int>& v) { return {v.begin(), v.end()}; }

/// Vertices that `from` reaches, itself included, by the definition.
std::vector<std::vector<char>> reachability(const Pattern& p) {
  const int n = p.columns();
  std::vector<std::vector<char>> reach(static_cast<std::size_t>(n));
  for (int from = 0; from < n; ++from) {
    auto& seen = reach[static_cast<std::size_t>(from)];
    seen.assign(static_cast<std::size_t>(n), 0);
    std::vector<int> queue{from};
    seen[static_cast<std::size_t>(from)] = 1;
    while (!queue.empty()) {
      const int j = queue.back();
      queue.pop_back();
      for (const int i : p.column(j))
        if (seen[static_cast<std::size_t>(i)] == 0) {
          seen[static_cast<std::size_t>(i)] = 1;
          queue.push_back(i);
        }
    }
  }
  return reach;
}

}  // namespace

TEST_CASE("matchings are maximum on 1500 random patterns, square and not, sparse and full") {
  test::Rng rng(11);
  for (int k = 0; k < 1500; ++k) {
    const int rows = test::whole(rng, 0, 40);
    const int columns = test::whole(rng, 0, 40);
    const Pattern p = test::random_pattern(rng, rows, columns, test::whole(rng, 0, 4 * (rows + columns)));
    const Matching m = maximum_matching(p);
    CAPTURE(k);
    CHECK(test::valid(p, m));
    CHECK(m.size == test::kuhn_size(p));
  }
}

TEST_CASE("columns named last stay unmatched wherever they can") {
  test::Rng rng(12);
  for (int k = 0; k < 300; ++k) {
    const int n = test::whole(rng, 1, 12);
    const Pattern p = test::random_pattern(rng, n, n, test::whole(rng, 0, 2 * n));
    std::vector<int> last(static_cast<std::size_t>(n));
    std::iota(last.begin(), last.end(), 0);
    std::shuffle(last.begin(), last.end(), rng);
    last.resize(static_cast<std::size_t>(test::whole(rng, 0, n)));
    const Matching m = maximum_matching(p, last);
    CHECK(test::valid(p, m));
    CHECK(m.size == test::kuhn_size(p));
    // Greedy in the transversal matroid: a column of `last` is matched exactly when it raises the rank of
    // the others and those before it.
    std::vector<char> kept(static_cast<std::size_t>(n), 1);
    for (const int j : last) kept[static_cast<std::size_t>(j)] = 0;
    const auto rank = [&] {
      std::vector<std::pair<int, int>> entries;
      for (int j = 0; j < n; ++j)
        if (kept[static_cast<std::size_t>(j)] != 0)
          for (const int i : p.column(j)) entries.emplace_back(j, i);
      return test::kuhn_size(Pattern(n, n, entries));
    };
    int before = rank();
    for (const int j : last) {
      kept[static_cast<std::size_t>(j)] = 1;
      const int after = rank();
      CHECK((m.row_of[static_cast<std::size_t>(j)] >= 0) == (after > before));
      before = after;
    }
  }
}

TEST_CASE("components are those of the definition, parents first, on 1000 random digraphs") {
  test::Rng rng(13);
  for (int k = 0; k < 1000; ++k) {
    const int n = test::whole(rng, 1, 14);
    const Pattern p = test::random_pattern(rng, n, n, test::whole(rng, 0, 3 * n));
    const auto reach = reachability(p);
    const Components c = strong_components(p);
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        const auto aa = static_cast<std::size_t>(a);
        const auto bb = static_cast<std::size_t>(b);
        CHECK((c.of[aa] == c.of[bb]) == (reach[aa][bb] != 0 && reach[bb][aa] != 0));
        if (reach[aa][bb] != 0) CHECK(c.of[bb] <= c.of[aa]);
      }
    const auto parent = parents(p, c);
    for (int a = 0; a < n; ++a) {
      bool leaves = false;
      for (int b = 0; b < n; ++b)
        leaves = leaves || (reach[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] != 0 &&
                            c.of[static_cast<std::size_t>(a)] != c.of[static_cast<std::size_t>(b)]);
      CHECK((parent[static_cast<std::size_t>(c.of[static_cast<std::size_t>(a)])] != 0) == !leaves);
    }
  }
}

TEST_CASE("Dulmage-Mendelsohn parts do not depend on the matching, and the fine blocks are triangular") {
  test::Rng rng(14);
  for (int k = 0; k < 1000; ++k) {
    const int rows = test::whole(rng, 0, 25);
    const int columns = test::whole(rng, 0, 25);
    const Pattern p = test::random_pattern(rng, rows, columns, test::whole(rng, 0, 2 * (rows + columns)));
    const Decomposition d = dulmage_mendelsohn(p);
    std::vector<int> order(static_cast<std::size_t>(columns));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), rng);
    const Decomposition other = dulmage_mendelsohn(p, maximum_matching(p, order));
    CAPTURE(k);
    CHECK(set_of(d.hor_cols) == set_of(other.hor_cols));
    CHECK(set_of(d.hor_rows) == set_of(other.hor_rows));
    CHECK(set_of(d.ver_rows) == set_of(other.ver_rows));
    CHECK(set_of(d.ver_cols) == set_of(other.ver_cols));
    CHECK(d.blocks() == other.blocks());
    CHECK(d.hor_cols.size() + d.sq_cols.size() + d.ver_cols.size() == static_cast<std::size_t>(columns));
    CHECK(d.hor_rows.size() + d.sq_rows.size() + d.ver_rows.size() == static_cast<std::size_t>(rows));
    CHECK((d.hor_cols.empty() || d.hor_cols.size() > d.hor_rows.size()));
    CHECK((d.ver_rows.empty() || d.ver_rows.size() > d.ver_cols.size()));
    std::vector<int> block_of_row(static_cast<std::size_t>(rows), -1);
    for (int b = 0; b < d.blocks(); ++b)
      for (int at = d.block_start[static_cast<std::size_t>(b)];
           at < d.block_start[static_cast<std::size_t>(b) + 1]; ++at)
        block_of_row[static_cast<std::size_t>(d.sq_rows[static_cast<std::size_t>(at)])] = b;
    for (int b = 0; b < d.blocks(); ++b)
      for (int at = d.block_start[static_cast<std::size_t>(b)];
           at < d.block_start[static_cast<std::size_t>(b) + 1]; ++at)
        for (const int i : p.column(d.sq_cols[static_cast<std::size_t>(at)]))
          CHECK(block_of_row[static_cast<std::size_t>(i)] <= b);
  }
}

TEST_CASE("contractions have one row less than columns, and their overlaps are as by the definition") {
  test::Rng rng(15);
  for (int k = 0; k < 500; ++k) {
    const int n = test::whole(rng, 1, 15);
    const Pattern p = test::random_pattern(rng, n, n, test::whole(rng, 0, 2 * n));
    const Decomposition d = dulmage_mendelsohn(p);
    std::vector<std::set<int>> groups;
    for (int j = 0; j < n; ++j) {
      if (d.matching.row_of[static_cast<std::size_t>(j)] >= 0) continue;
      const auto contraction = reachable_columns(p, d.matching, std::span(&j, 1));
      std::set<int> rows;
      for (const int c : contraction) rows.insert(p.column(c).begin(), p.column(c).end());
      CHECK(rows.size() + 1 == contraction.size());
      std::set<int> merged = set_of(contraction);
      std::erase_if(groups, [&](const std::set<int>& g) {
        const bool overlap = std::any_of(g.begin(), g.end(), [&](int c) { return merged.contains(c); });
        if (overlap) merged.insert(g.begin(), g.end());
        return overlap;
      });
      groups.push_back(merged);
    }
    std::set<std::set<int>> got;
    for (const auto& one : contraction_components(p, d)) got.insert(set_of(one));
    CHECK(got == std::set<std::set<int>>(groups.begin(), groups.end()));
  }
}

TEST_CASE("no recursion: a chain of ten million links, both ways") {
  constexpr int n = test::tried(10'000'000);
  std::vector<int> start(n + 1);
  std::vector<int> index;
  index.reserve(2 * static_cast<std::size_t>(n));
  // Column j has rows j and j + 1 (the last one row 0): depth-first paths as long as the chain.
  for (int j = 0; j < n; ++j) {
    start[static_cast<std::size_t>(j)] = static_cast<int>(index.size());
    index.push_back(j);
    index.push_back((j + 1) % n);
  }
  start.back() = static_cast<int>(index.size());
  const Pattern ring(n, start, index);
  CHECK(strong_components(ring).count == 1);
  const Decomposition d = dulmage_mendelsohn(ring);
  CHECK(d.structural_rank() == n);
  CHECK(d.blocks() == 1);
  // Without row 0's second entry: one augmenting path through all, then n blocks of one.
  index.back() = 1;
  index[0] = 1;
  CHECK(dulmage_mendelsohn(Pattern(n, start, index)).structural_rank() == n - 1);
}

TEST_CASE("patterns refuse what does not fit") {
  CHECK_THROWS_WITH_AS(Pattern(2, 2, std::vector<std::pair<int, int>>{{2, 0}}),
                       doctest::Contains("edge: got (2, 0)"), InvalidInput);
  CHECK_THROWS_AS(Pattern(2, {0, 2}, {0, 2}), InvalidInput);
  CHECK_THROWS_AS(Pattern(2, {0, 3}, {0, 1}), InvalidInput);
  Matrix bad = Matrix::Zero(2, 2);
  bad(1, 0) = kNaN;
  CHECK_THROWS_WITH_AS(Pattern::of(bad), doctest::Contains("pattern[1, 0]"), InvalidInput);
  CHECK_THROWS_AS(strong_components(Pattern(2, {0, 1}, {1})), InvalidInput);
  CHECK(Pattern::of(Matrix::Constant(1, 1, 1e-9), 1e-6).entries() == 0);
}
