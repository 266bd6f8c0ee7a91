// SPDX-License-Identifier: Apache-2.0
// The newest measurement, from the thread that reads the sensor to the loop, which never waits for it.
#pragma once

#include <atomic>
#include <vector>

#include "garrison/core/types.hpp"
#include "garrison/node/bytes.hpp"

namespace garrison::node {

class Reading {
 public:
  explicit Reading(std::size_t outputs) : values_(outputs) {}

  void put(std::span<const double> y, Micros taken) noexcept {
    const std::uint64_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k].store(y[k], std::memory_order_relaxed);
    taken_.store(taken, std::memory_order_relaxed);
    turn_.store(turn + 2, std::memory_order_release);
  }

  /// NaN where there is none, where it is older than `most`, or where it is just being written.
  void get(Micros now, Micros most, std::span<double> y) const noexcept {
    const std::uint64_t before = turn_.load(std::memory_order_acquire);
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = values_[k].load(std::memory_order_relaxed);
    const Micros age = now - taken_.load(std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_acquire);
    const bool whole = before % 2 == 0 && turn_.load(std::memory_order_relaxed) == before;
    if (before == 0 || !whole || age < 0 || age > most) std::fill(y.begin(), y.end(), kNaN);
  }

 private:
  std::atomic<std::uint64_t> turn_{0};
  std::vector<std::atomic<double>> values_;
  std::atomic<Micros> taken_{0};
};

}  // namespace garrison::node
