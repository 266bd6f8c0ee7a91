// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/plan/ordering.hpp"

#include <algorithm>

namespace garrison {
namespace {

class Search {
 public:
  Search(std::span<const int> offsets, std::span<const int> lists)
      : offsets_(offsets), lists_(lists), mark_(offsets.size() - 1, 0) {}

  int degree(int i) const {
    return offsets_[static_cast<std::size_t>(i) + 1] - offsets_[static_cast<std::size_t>(i)];
  }

  bool done(int i) const { return mark_[static_cast<std::size_t>(i)] == kDone; }
  void finish(int i) { mark_[static_cast<std::size_t>(i)] = kDone; }

  /// Breadth-first order from `start` over agents that are not done, neighbours by degree; returns where
  /// the last level begins.
  std::size_t levels(int start, std::vector<int>& order) {
    ++stamp_;
    const std::size_t begin = order.size();
    order.push_back(start);
    mark_[static_cast<std::size_t>(start)] = stamp_;
    std::size_t level = begin;
    std::size_t level_end = order.size();
    for (std::size_t k = begin; k < order.size(); ++k) {
      if (k == level_end) {
        level = level_end;
        level_end = order.size();
      }
      const std::size_t fresh = order.size();
      for (int e = offsets_[static_cast<std::size_t>(order[k])];
           e < offsets_[static_cast<std::size_t>(order[k]) + 1]; ++e) {
        const int j = lists_[static_cast<std::size_t>(e)];
        if (mark_[static_cast<std::size_t>(j)] == stamp_ || done(j)) continue;
        mark_[static_cast<std::size_t>(j)] = stamp_;
        order.push_back(j);
      }
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(fresh), order.end(),
                [&](int a, int b) { return std::pair(degree(a), a) < std::pair(degree(b), b); });
    }
    return level;
  }

 private:
  static constexpr int kDone = -1;
  std::span<const int> offsets_;
  std::span<const int> lists_;
  std::vector<int> mark_;  // the last search that saw the agent, or kDone
  int stamp_ = 0;
};

}  // namespace

std::vector<int> reverse_cuthill_mckee(std::span<const int> offsets, std::span<const int> lists) {
  const std::size_t N = offsets.size() - 1;
  Search search(offsets, lists);
  std::vector<int> by_degree(N);
  for (std::size_t i = 0; i < N; ++i) by_degree[i] = static_cast<int>(i);
  std::stable_sort(by_degree.begin(), by_degree.end(),
                   [&](int a, int b) { return search.degree(a) < search.degree(b); });
  std::vector<int> order;
  std::vector<int> probe;
  const auto take = [&](int start) {
    const std::size_t begin = order.size();
    search.levels(start, order);
    for (std::size_t k = begin; k < order.size(); ++k) search.finish(order[k]);
  };
  for (const int seed : by_degree) {
    if (search.done(seed)) continue;
    // Two sweeps towards an end of the component: a long, thin level structure has a small bandwidth.
    int start = seed;
    for (int sweep = 0; sweep < 2; ++sweep) {
      probe.clear();
      const std::size_t last = search.levels(start, probe);
      start = probe[last];
    }
    take(start);
    if (!search.done(seed)) take(seed);  // one-way edges: the end does not lead back
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace garrison
