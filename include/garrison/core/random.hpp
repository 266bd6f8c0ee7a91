// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: a value depends only on its key, never on who asked before.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace garrison {

/// What a random number is for; keeps streams of one (seed, trial, agent, time) apart.
enum class Purpose : std::uint32_t { graph, position, process, measurement, start, attack, link };

/// Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011): the block of
/// four words that belongs to `counter` under `key`.
inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                           std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53U} * counter[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57U} * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key = {key[0] + 0x9E3779B9U, key[1] + 0xBB67AE85U};
  }
  return counter;
}

/// Random numbers of one purpose and trial. `draw` addresses them by (time, agent, index).
/// Threads: constant once made; any number may share it.
class Random {
 public:
  Random(std::uint64_t seed, std::uint32_t trial, Purpose purpose, std::uint32_t salt = 0)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        stream_{trial ^ (static_cast<std::uint32_t>(purpose) << 24) ^ (salt << 28)} {}

  /// Uniform in [0, 1).
  double uniform(std::int64_t time, std::uint32_t agent, std::uint32_t index = 0) const {
    return unit(block(time, agent, index), 0);
  }
  /// Standard normal (Box-Muller).
  double normal(std::int64_t time, std::uint32_t agent, std::uint32_t index = 0) const {
    const auto words = block(time, agent, index);
    const double radius = std::sqrt(-2.0 * std::log1p(-unit(words, 0)));
    return radius * std::cos(2.0 * std::numbers::pi * unit(words, 1));
  }

  /// Of philox: block(time, agent, index) has the counter (time, agent, index, stream) under this key.
  std::array<std::uint32_t, 2> key() const { return key_; }
  std::uint32_t stream() const { return stream_; }

 private:
  std::array<std::uint32_t, 4> block(std::int64_t time, std::uint32_t agent, std::uint32_t index) const {
    return philox({static_cast<std::uint32_t>(time), agent, index, stream_}, key_);
  }
  static double unit(const std::array<std::uint32_t, 4>& words, int half) {
    const auto i = static_cast<std::size_t>(2 * half);
    const std::uint64_t bits = (std::uint64_t{words[i]} << 32) | words[i + 1];
    return static_cast<double>(bits >> 11) * 0x1.0p-53;
  }

  std::array<std::uint32_t, 2> key_;
  std::uint32_t stream_;
};

}  // namespace garrison
