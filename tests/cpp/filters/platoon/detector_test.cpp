// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/platoon/detector.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "../../random_system.hpp"
#include "garrison/core/label_set.hpp"

using namespace garrison;
using namespace garrison::platoon;

TEST_CASE("runs and their count: Remark 7 of the paper, and every subset of ten labels") {
  const std::vector<int> remark{1, 2, 3, 6, 9, 10, 11, 12, 15};
  CHECK(count_runs(remark) == 5);
  CHECK(runs(remark) == std::vector<std::vector<int>>{{1, 2, 3}, {6}, {9, 10, 11, 12}, {15}});
  for (unsigned subset = 0; subset < 1024; ++subset) {
    std::vector<int> labels;
    for (int k = 0; k < 10; ++k)
      if ((subset >> k & 1U) != 0) labels.push_back(k);
    int count = 0;
    for (const auto& run : runs(labels)) count += static_cast<int>(run.size() + 2) / 3;
    CHECK(count_runs(labels) == count);
  }
}

TEST_CASE("least cover of pairs on a path against all subsets") {
  for (unsigned chosen = 0; chosen < 512; ++chosen) {
    std::vector<int> edges;
    for (int e = 0; e < 9; ++e)
      if ((chosen >> e & 1U) != 0) edges.push_back(e);
    int least = 10;
    for (unsigned cover = 0; cover < 1024; ++cover) {
      const bool covers = std::all_of(edges.begin(), edges.end(),
                                      [&](int e) { return ((cover >> e | cover >> (e + 1)) & 1U) != 0; });
      if (covers) least = std::min(least, std::popcount(cover));
    }
    CHECK(path_cover(edges) == least);
    // The exact count is never weaker than that of runs: one attacked sensor fires at most two pairs.
    std::set<int> suspects;
    for (const int e : edges) suspects.insert({e, e + 1});
    CHECK(path_cover(edges) >= count_runs(std::vector<int>(suspects.begin(), suspects.end())));
  }
}

TEST_CASE("what fired pairs prove, against all covers, in 4000 random windows") {
  test::Rng rng(3);
  int proved = 0;
  for (int run = 0; run < 4000; ++run) {
    const int size = test::whole(rng, 3, 9);
    const int budget = test::whole(rng, 0, 4);
    Suspicions fired(size);
    std::vector<std::pair<int, int>> pairs;
    for (int j = 0; j < size; ++j)
      for (int k = j + 1; k < size; ++k)
        if (test::uniform(rng, 0, 1) < 0.25) {
          pairs.emplace_back(j, k);
          fired.fire(j, k);
        }
    const auto known_a = std::uint64_t{test::uniform(rng, 0, 1) < 0.2} << test::whole(rng, 0, size - 1);
    auto known_f = std::uint64_t{test::uniform(rng, 0, 1) < 0.2} << test::whole(rng, 0, size - 1);
    known_f &= ~known_a;
    std::uint64_t in_all = ~std::uint64_t{0};
    std::uint64_t in_some = 0;
    for (std::uint64_t cover = 0; cover < (std::uint64_t{1} << size); ++cover) {
      if (std::popcount(cover) > budget || (cover & known_f) != 0 || (cover & known_a) != known_a) continue;
      const bool covers = std::all_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
        return ((cover >> pair.first | cover >> pair.second) & 1U) != 0;
      });
      if (!covers) continue;
      in_all &= cover;
      in_some |= cover;
    }
    const auto found = fired.conclude(known_a, known_f, budget);
    const std::uint64_t all = (std::uint64_t{1} << size) - 1;
    CAPTURE(run);
    if (in_all == ~std::uint64_t{0}) {
      CHECK(found.contradiction);
      continue;
    }
    CHECK_FALSE(found.contradiction);
    CHECK((found.attacked | known_a) == in_all);
    CHECK((found.free | known_f) == (all & ~in_some));
    proved += found.attacked != 0 ? 1 : 0;
  }
  CHECK(proved > 100);
}

TEST_CASE("sets of labels behave as sets, finite and cofinite, in 20000 random operations") {
  constexpr int kLabels = 40;
  test::Rng rng(5);
  std::vector<LabelSet> sets(4, LabelSet(2 * kLabels));
  for (auto& set : sets) {
    set = LabelSet(2 * kLabels);
  }
  std::vector<std::set<int>> truth(4);
  for (int step = 0; step < 20000; ++step) {
    const auto a = static_cast<std::size_t>(test::whole(rng, 0, 3));
    const auto b = static_cast<std::size_t>(test::whole(rng, 0, 3));
    const int id = test::whole(rng, 0, kLabels - 1);
    switch (test::whole(rng, 0, 11)) {
      case 0:
        CHECK(sets[a].unite(sets[b]));
        truth[a].insert(truth[b].begin(), truth[b].end());
        break;
      case 1: {
        sets[a].clear();
        truth[a].clear();
        break;
      }
      case 2: {
        std::vector<int> excluded;
        for (int k = 0; k < kLabels; ++k)
          if (test::uniform(rng, 0, 1) < 0.2) excluded.push_back(k);
        CHECK(sets[a].unite_all_but(excluded));
        for (int k = 0; k < kLabels; ++k)
          if (!std::binary_search(excluded.begin(), excluded.end(), k)) truth[a].insert(k);
        break;
      }
      case 3:
        sets[a] = sets[b];
        truth[a] = truth[b];
        break;
      default:
        CHECK(sets[a].insert(id));
        truth[a].insert(id);
    }
    for (int k = 0; k < kLabels; ++k) CHECK(sets[a].contains(k) == (truth[a].count(k) == 1));
  }
  LabelSet small(2);
  CHECK(small.insert(3));
  CHECK(small.insert(1));
  CHECK_FALSE(small.insert(2));
  CHECK(small.listed()[0] == 1);
  CHECK(small.count() == 2);
}
