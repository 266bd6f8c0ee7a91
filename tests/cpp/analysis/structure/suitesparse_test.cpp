// SPDX-License-Identifier: Apache-2.0
// Structural rank, Dulmage-Mendelsohn parts and strong components against SuiteSparse (CXSparse, BTF).
#include <doctest/doctest.h>
#include <suitesparse/btf.h>
#include <suitesparse/cs.h>

#include <set>

#include "garrison/analysis/structure/components.hpp"
#include "garrison/analysis/structure/dulmage_mendelsohn.hpp"
#include "random_pattern.hpp"

using namespace garrison;
using namespace garrison::structure;

namespace {

std::set<int> between(const int* order, int from, int to) { return {order + from, order + to}; }
std::set<int> set_of(const std::vector<int>& v) { return {v.begin(), v.end()}; }

void same_parts(const Pattern& p) {
  cs_di A{};  // a view: SuiteSparse does not write to its input
  A.nzmax = p.entries();
  A.m = p.rows();
  A.n = p.columns();
  A.p = const_cast<int*>(p.start());
  A.i = const_cast<int*>(p.index());
  A.nz = -1;
  cs_did* theirs = cs_di_dmperm(&A, 0);
  REQUIRE(theirs != nullptr);
  const Decomposition ours = dulmage_mendelsohn(p);
  const int* cc = theirs->cc;  // coarse boundaries: columns, rows
  const int* rr = theirs->rr;
  CHECK(ours.structural_rank() == rr[3]);
  CHECK(set_of(ours.hor_cols) == between(theirs->q, 0, cc[2]));
  CHECK(set_of(ours.hor_rows) == between(theirs->p, 0, rr[1]));
  CHECK(set_of(ours.sq_cols) == between(theirs->q, cc[2], cc[3]));
  CHECK(set_of(ours.sq_rows) == between(theirs->p, rr[1], rr[2]));
  CHECK(set_of(ours.ver_cols) == between(theirs->q, cc[3], cc[4]));
  CHECK(set_of(ours.ver_rows) == between(theirs->p, rr[2], rr[4]));
  std::set<std::set<int>> blocks, found;
  for (int b = 0; b < theirs->nb; ++b)
    if (theirs->s[b] >= cc[2] && theirs->s[b + 1] <= cc[3] && theirs->s[b] < theirs->s[b + 1])
      blocks.insert(between(theirs->q, theirs->s[b], theirs->s[b + 1]));
  for (int b = 0; b < ours.blocks(); ++b)
    found.insert(between(ours.sq_cols.data(), ours.block_start[static_cast<std::size_t>(b)],
                         ours.block_start[static_cast<std::size_t>(b) + 1]));
  CHECK(found == blocks);
  cs_di_dfree(theirs);
}

}  // namespace

TEST_CASE(
    "Dulmage-Mendelsohn: rank, all six parts and the fine blocks are CXSparse's on 1500 random patterns") {
  test::Rng rng(21);
  for (int k = 0; k < 1500; ++k) {
    const int rows = test::whole(rng, 1, 60);
    const int columns = k % 2 == 0 ? rows : test::whole(rng, 1, 60);
    CAPTURE(k);
    same_parts(test::random_pattern(rng, rows, columns, test::whole(rng, 0, 3 * (rows + columns))));
  }
  same_parts(test::random_pattern(rng, 40'000, 40'000, 120'000));
}

TEST_CASE(
    "deficient patterns, on which searches column by column are given up, are CXSparse's from both sides") {
  test::Rng rng(23);
  for (int k = 0; k < 20; ++k) {
    const int rows = test::whole(rng, 2000, 3000);
    const int columns = rows + (k % 3 - 1) * rows / 50;
    CAPTURE(k);
    const Pattern p = test::random_pattern(rng, rows, columns, 3 * rows);
    CHECK(test::valid(p, maximum_matching(p)));
    same_parts(p);
  }
}

TEST_CASE("structural rank and strong components are BTF's on 1500 random patterns") {
  test::Rng rng(22);
  for (int k = 0; k < 1500; ++k) {
    const int n = test::whole(rng, 1, 60);
    const Pattern p = test::random_pattern(rng, n, n, test::whole(rng, 0, 4 * n));
    auto* start = const_cast<int*>(p.start());
    auto* index = const_cast<int*>(p.index());
    const auto size = static_cast<std::size_t>(n);
    std::vector<int> order(size), first(size + 1), match(size), work(5 * size);
    double done = 0.0;
    CAPTURE(k);
    CHECK(maximum_matching(p).size ==
          btf_maxtrans(n, n, start, index, -1.0, &done, match.data(), work.data()));
    const int count = btf_strongcomp(n, start, index, nullptr, order.data(), first.data(), work.data());
    std::set<std::set<int>> theirs, ours;
    for (int c = 0; c < count; ++c)
      theirs.insert(
          between(order.data(), first[static_cast<std::size_t>(c)], first[static_cast<std::size_t>(c) + 1]));
    for (const auto& one : strong_components(p).lists()) ours.insert(set_of(one));
    CHECK(ours == theirs);
  }
}
