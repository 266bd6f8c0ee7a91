// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/plan/consensus.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#ifdef __unix__
#include <unistd.h>
#endif

#include "garrison/engine/plan/ordering.hpp"

namespace garrison {
namespace {

// Rows are sorted by degree inside windows of this many, so that inner loops keep their trip count.
constexpr std::int32_t kWindow = 256;
// Networks whose rows fit a second-level cache gain nothing from fused rounds.
constexpr std::size_t kFitsAnyway = std::size_t{1} << 20;

/// Bytes of rows in flight: half of a large second-level cache, else a part of the third-level cache.
std::size_t in_flight() {
#ifdef _SC_LEVEL2_CACHE_SIZE
  static const long second_level = sysconf(_SC_LEVEL2_CACHE_SIZE);
  if (second_level >= 1L << 20) return static_cast<std::size_t>(second_level) / 2;
#endif
  return std::size_t{8} << 20;
}

}  // namespace

ConsensusPlan::ConsensusPlan(std::span<const int> offsets, std::span<const int> lists, int width)
    : width_(width) {
  const std::int64_t numbers = static_cast<std::int64_t>(offsets.size() - 1) * width;
  if (numbers > std::numeric_limits<std::int32_t>::max())
    refuse("network", amount(offsets.size() - 1, "agent") + " with " + amount(width, "number"),
           "fewer than 2^31 numbers in all", "split the network");
  order_ = reverse_cuthill_mckee(offsets, lists);
  const auto degree = [&](int i) {
    return offsets[static_cast<std::size_t>(i) + 1] - offsets[static_cast<std::size_t>(i)];
  };
  const auto N = static_cast<std::int32_t>(order_.size());
  for (std::int32_t w = 0; w < N; w += kWindow)
    std::stable_sort(order_.begin() + w, order_.begin() + std::min(w + kWindow, N),
                     [&](int a, int b) { return degree(a) < degree(b); });
  std::vector<std::int32_t> position(order_.size());
  for (std::int32_t k = 0; k < N; ++k)
    position[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])] = k;
  std::int32_t bandwidth = 0;
  for (std::int32_t k = 0; k < N; ++k) {
    const int i = order_[static_cast<std::size_t>(k)];
    if (k % kWindow == 0) windows_.push_back(static_cast<std::int32_t>(runs_.size()));
    if (k % kWindow == 0 || runs_.back().degree != degree(i))
      runs_.push_back({k, k, degree(i), static_cast<std::int32_t>(neighbour_.size())});
    runs_.back().end = k + 1;
    for (int e = offsets[static_cast<std::size_t>(i)]; e < offsets[static_cast<std::size_t>(i) + 1]; ++e) {
      const auto j = position[static_cast<std::size_t>(lists[static_cast<std::size_t>(e)])];
      neighbour_.push_back(j * width);
      bandwidth = std::max(bandwidth, std::abs(j - k));
    }
  }
  windows_.push_back(static_cast<std::int32_t>(runs_.size()));
  reach_ = bandwidth / kWindow + 1;
}

int ConsensusPlan::rounds_in_flight() const {
  const std::size_t row = static_cast<std::size_t>(width_) * 2 * sizeof(double);
  if (order_.size() * row <= kFitsAnyway) return 1;
  return static_cast<int>(
      std::min<std::size_t>(in_flight() / (row * kWindow * static_cast<std::size_t>(reach_)), 64));
}

void ConsensusPlan::run(double* x, double* scratch, double alpha, std::span<const double> omega, int rounds,
                        Workers* workers) const {
  double* buffers[2] = {x, scratch};
  const auto windows = static_cast<std::int64_t>(windows_.size()) - 1;
  const auto average = [&](int round, std::int64_t begin, std::int64_t end) {
    const double weight = omega.empty() ? 1.0 : omega[static_cast<std::size_t>(round)];
    kernel::average_runs({neighbour_.data(), buffers[round % 2], buffers[(round + 1) % 2], alpha, weight},
                         runs_.data() + windows_[static_cast<std::size_t>(begin)],
                         runs_.data() + windows_[static_cast<std::size_t>(end)], width_);
  };
  const bool threaded = workers != nullptr && workers->threads() > 1;
  const int fused = threaded ? 1 : rounds_in_flight();
  if (fused < 2) {
    for (int round = 0; round < rounds; ++round) {
      if (threaded)
        workers->split(windows,
                       [&](std::int64_t begin, std::int64_t end, int) { average(round, begin, end); });
      else
        average(round, 0, windows);
    }
  } else {
    // Skewed tiles: round l works `reach` windows behind round l-1, so its neighbours are ready, and round
    // l+1 overwrites only what round l no longer reads. The rows in flight stay in cache.
    const std::int64_t reach = reach_;
    for (int base = 0; base < rounds; base += fused) {
      const int group = std::min(fused, rounds - base);
      const std::int64_t end = windows + (group - 1) * reach;
      for (std::int64_t front = 0; front < end; front += 2 * reach)
        for (int l = 0; l < group; ++l) {
          const std::int64_t from = std::clamp<std::int64_t>(front - l * reach, 0, windows);
          const std::int64_t to = std::clamp<std::int64_t>(front + (2 - l) * reach, 0, windows);
          average(base + l, from, to);
        }
    }
  }
  if (rounds % 2 != 0) std::copy_n(scratch, order_.size() * static_cast<std::size_t>(width_), x);
}

}  // namespace garrison
