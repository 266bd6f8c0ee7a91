// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/platoon/detector.hpp"

namespace garrison::platoon {

std::vector<std::vector<int>> runs(std::span<const int> sorted) {
  std::vector<std::vector<int>> all;
  for (const int label : sorted) {
    if (all.empty() || all.back().back() + 1 != label) all.emplace_back();
    all.back().push_back(label);
  }
  return all;
}

int count_runs(std::span<const int> sorted) noexcept {
  int count = 0;
  int length = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    length = k > 0 && sorted[k - 1] + 1 == sorted[k] ? length + 1 : 1;
    count += length % 3 == 1 ? 1 : 0;  // ceil(length / 3) grows with every third label
  }
  return count;
}

int path_cover(std::span<const int> edges) noexcept {
  int count = 0;
  bool covered = false;  // the end of the edge before has been taken
  for (std::size_t k = 0; k < edges.size(); ++k) {
    covered = covered && edges[k - 1] + 1 == edges[k];
    if (covered) {
      covered = false;
    } else {
      ++count;  // take the far end: it covers the next edge too
      covered = true;
    }
  }
  return count;
}

bool Suspicions::coverable(std::uint64_t in, std::uint64_t out, int budget) const noexcept {
  for (int j = 0; j < size_; ++j) {
    if ((in & bit(j)) != 0) continue;
    const std::uint64_t open = edges_[static_cast<std::size_t>(j)] & ~in;
    if (open == 0) continue;
    // Either j is in the cover, or all its open neighbours are.
    if (budget > 0 && (out & bit(j)) == 0 && coverable(in | bit(j), out, budget - 1)) return true;
    const int needed = std::popcount(open);
    return (open & out) == 0 && needed <= budget && coverable(in | open, out | bit(j), budget - needed);
  }
  return true;
}

Suspicions::Verdicts Suspicions::conclude(std::uint64_t attacked, std::uint64_t free,
                                          int budget) const noexcept {
  Verdicts found;
  const int left = budget - std::popcount(attacked);
  if (left < 0 || !coverable(attacked, free, left)) {
    found.contradiction = true;
    return found;
  }
  for (int j = 0; j < size_; ++j) {
    if (((attacked | free) & bit(j)) != 0) continue;
    if ((touched_ & bit(j)) != 0 && !coverable(attacked, free | bit(j), left)) found.attacked |= bit(j);
    if (left == 0 || !coverable(attacked | bit(j), free, left - 1)) found.free |= bit(j);
  }
  return found;
}

}  // namespace garrison::platoon
