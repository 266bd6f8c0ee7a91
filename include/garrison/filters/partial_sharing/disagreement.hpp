// SPDX-License-Identifier: Apache-2.0
// sum_j S_j (xbar_j - xhat_i) straight from the predictions of the whole network, without messages.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "garrison/core/block.hpp"
#include "garrison/core/clones.hpp"
#include "garrison/core/types.hpp"

namespace garrison::partial_sharing {

/// Entries that agents share, a bit each, `shift` entries further on.
template <int n>
std::uint8_t shifted(std::uint8_t bits, int shift) {
  return static_cast<std::uint8_t>(((bits << shift) | (bits >> (n - shift))) & ((1 << n) - 1));
}

/// For agents begin..end-1, all of whose predictions are plain: the bits are those of messages, since entries
/// that were not shared add zero.
template <int n>
struct Disagreement {
  /// x: predictions, agent by agent; `shares`: bits of every agent's entries; `wiring`: agent k hears
  /// slots[first[k]] .. slots[first[k + 1] - 1]; u: of agent `begin` first.
  template <int B, class Wiring>
  GARRISON_INLINE static void run(const double* x, const std::uint8_t* shares, Wiring wiring,
                                  std::size_t begin, std::size_t end, double* u) noexcept {
    constexpr int W = block_of(n, std::min(B, 4));
    using V = typename Block<W>::type;
    using Mask = decltype(V{} < V{});
    static constexpr auto kMasks = masks<W>();
    for (std::size_t k = begin; k < end; ++k, u += n) {
      V own[n / W];
      V sum[n / W];
      for (int c = 0; c < n / W; ++c) {
        own[c] = *Block<W>::of(x + k * n + c * W);
        sum[c] = V{};
      }
      for (std::size_t e = wiring.first[k]; e < wiring.first[k + 1]; ++e) {
        const std::size_t j = wiring.slots[e];
        const int bits = shares[j];
        for (int c = 0; c < n / W; ++c) {
          const V apart = *Block<W>::of(x + j * n + c * W) - own[c];
          const auto& shared = *reinterpret_cast<const Mask*>(kMasks.row[(bits >> (c * W)) % (1 << W)]);
          sum[c] += shared ? apart : V{};
        }
      }
      for (int c = 0; c < n / W; ++c) *Block<W>::of(u + c * W) = sum[c];
    }
  }

 private:
  /// Every choice of W entries, all ones where chosen.
  template <int W>
  struct Masks {
    alignas(32) std::int64_t row[1 << W][W];
  };
  template <int W>
  static constexpr Masks<W> masks() {
    Masks<W> all{};
    for (int bits = 0; bits < 1 << W; ++bits)
      for (int a = 0; a < W; ++a) all.row[bits][a] = (bits >> a) % 2 == 1 ? -1 : 0;
    return all;
  }
};

}  // namespace garrison::partial_sharing
