// SPDX-License-Identifier: Apache-2.0
#include "garrison/runtime/consensus.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "consensus_kernel.hpp"
#include "garrison/runtime/ordering.hpp"

namespace garrison {
namespace {

// Rows are sorted by degree inside windows of this many, so that inner loops keep their trip count.
constexpr std::ptrdiff_t kWindow = 128;
// Both buffers of the rows that are in flight should stay in half of a 1 MiB second-level cache.
constexpr std::size_t kCache = 512 * 1024;

}  // namespace

ConsensusPlan::ConsensusPlan(std::span<const int> offsets, std::span<const int> lists) {
  order_ = reverse_cuthill_mckee(offsets, lists);
  const auto degree = [&](int i) {
    return offsets[static_cast<std::size_t>(i) + 1] - offsets[static_cast<std::size_t>(i)];
  };
  const auto N = static_cast<std::ptrdiff_t>(order_.size());
  for (std::ptrdiff_t w = 0; w < N; w += kWindow)
    std::stable_sort(order_.begin() + w, order_.begin() + std::min(w + kWindow, N),
                     [&](int a, int b) { return degree(a) < degree(b); });
  std::vector<std::int32_t> position(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k)
    position[static_cast<std::size_t>(order_[k])] = static_cast<std::int32_t>(k);
  first_.push_back(0);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const auto i = static_cast<std::size_t>(order_[k]);
    for (int e = offsets[i]; e < offsets[i + 1]; ++e) {
      neighbour_.push_back(position[static_cast<std::size_t>(lists[static_cast<std::size_t>(e)])]);
      bandwidth_ = std::max(bandwidth_, std::abs(neighbour_.back() - static_cast<std::int32_t>(k)));
    }
    first_.push_back(static_cast<std::int32_t>(neighbour_.size()));
  }
}

int ConsensusPlan::rounds_in_flight(int width) const {
  const auto row = static_cast<std::size_t>(width) * 2 * sizeof(double);
  if (order_.size() * row <= kCache) return 1;
  return static_cast<int>(
      std::min<std::size_t>(kCache / (row * static_cast<std::size_t>(bandwidth_ + 1)), 64));
}

void ConsensusPlan::run(double* x, double* scratch, int width, double alpha, std::span<const double> omega,
                        int rounds, Workers* workers) const {
  double* buffers[2] = {x, scratch};
  const auto N = static_cast<std::int32_t>(order_.size());
  const auto row_range = [&](int round, std::int32_t begin, std::int32_t end) {
    const double weight = omega.empty() ? 1.0 : omega[static_cast<std::size_t>(round)];
    kernel::average_rows({first_.data(), neighbour_.data(), buffers[round % 2], buffers[(round + 1) % 2],
                          begin, end, alpha, weight},
                         width);
  };
  const bool threaded = workers != nullptr && workers->threads() > 1;
  const int fused = threaded ? 1 : rounds_in_flight(width);
  if (fused < 2) {
    for (int round = 0; round < rounds; ++round) {
      if (threaded)
        workers->split(N, [&](std::int64_t begin, std::int64_t end, int) {
          row_range(round, static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end));
        });
      else
        row_range(round, 0, N);
    }
  } else {
    // Skewed tiles: round l works `bandwidth` rows behind round l-1, so its neighbours are ready, and round
    // l+1 overwrites only what round l no longer reads. The rows in flight stay in cache.
    for (int base = 0; base < rounds; base += fused) {
      const int group = std::min(fused, rounds - base);
      const std::int64_t block = std::max<std::int64_t>(bandwidth_ / 4, 64);
      const std::int64_t end = N + static_cast<std::int64_t>(group - 1) * bandwidth_;
      const auto clamp = [&](std::int64_t r) {
        return static_cast<std::int32_t>(std::clamp<std::int64_t>(r, 0, N));
      };
      for (std::int64_t front = 0; front < end; front += block)
        for (int l = 0; l < group; ++l) {
          const std::int64_t lag = static_cast<std::int64_t>(l) * bandwidth_;
          row_range(base + l, clamp(front - lag), clamp(front + block - lag));
        }
    }
  }
  if (rounds % 2 != 0) std::copy_n(scratch, order_.size() * static_cast<std::size_t>(width), x);
}

}  // namespace garrison
