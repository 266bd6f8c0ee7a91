// SPDX-License-Identifier: Apache-2.0
// What the engine asks of partial_sharing when it steps several agents at once
// (engine/batch/side_by_side.hpp): above all sum_j S_j (xbar_j - xhat_i) straight from the predictions of the
// whole network, without messages.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/partial_sharing/update.hpp"
#include "garrison/kernel/block.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison {
namespace partial_sharing {

/// Entries that agents share, a bit each, `shift` entries further on.
template <int n>
std::uint8_t shifted(std::uint8_t bits, int shift) {
  return static_cast<std::uint8_t>(((bits << shift) | (bits >> (n - shift))) & ((1 << n) - 1));
}

/// n words for every set of entries: all ones where an entry is in the set, else zero.
template <int n>
constexpr auto make_masks() {
  std::array<std::int64_t, (std::size_t{1} << n) * n> masks{};
  for (std::size_t k = 0; k < masks.size(); ++k) masks[k] = -static_cast<std::int64_t>(k / n >> k % n & 1);
  return masks;
}
template <int n>
alignas(64) inline constexpr auto kMasks = make_masks<n>();

/// For agents begin..end-1, all of whose predictions are plain: the bits are those of messages, since entries
/// that were not shared add zero.
template <int n>
struct Disagreement {
  /// x: predictions, agent by agent; `shares`: bits of every agent's entries; `wiring`: agent k hears
  /// slots[first[k]] .. slots[first[k + 1] - 1]; u: of agent `begin` first.
  template <int B, class Wiring>
  GARRISON_INLINE static void run(const double* x, const std::uint8_t* shares, Wiring wiring,
                                  std::size_t begin, std::size_t end, double* u) noexcept {
    constexpr int W = block_of(n, B);
    using V = typename Block<W>::type;
    using Bits = decltype(V{} < V{});
    for (std::size_t k = begin; k < end; ++k, u += n) {
      V own[std::size_t{n / W}];
      V sum[std::size_t{n / W}];
      for (int c = 0; c < n / W; ++c) {
        own[c] = *Block<W>::of(x + k * n + c * W);
        sum[c] = V{};
      }
#pragma GCC unroll 4
      for (std::size_t e = wiring.first[k]; e < wiring.first[k + 1]; ++e) {
        const std::size_t j = wiring.slots[e];
        const std::int64_t* const shared = kMasks<n>.data() + std::size_t{shares[j]} * n;
        for (int c = 0; c < n / W; ++c) {
          const V ahead = own[c] - *Block<W>::of(x + j * n + c * W);
          Bits mask;
          std::memcpy(&mask, shared + c * W, sizeof(mask));
          sum[c] -= V(Bits(ahead) & mask);
        }
      }
      for (int c = 0; c < n / W; ++c) *Block<W>::of(u + c * W) = sum[c];
    }
  }
};

}  // namespace partial_sharing

template <int n>
class PartialSharing::SideBySide {
 public:
  using Group = partial_sharing::Group<n>;
  using Update = partial_sharing::Update<n>;
  using Common = partial_sharing::Common;
  using Outcome = partial_sharing::Outcome;

  static void place(State<n>& s, Group* group, int lane) {
    s.group = std::shared_ptr<Group>(std::shared_ptr<void>(), group);  // not the agent's own
    s.lane = lane;
  }
  static Common common(const Local& any, const Gains& g) noexcept { return PartialSharing::common(any, g); }

  template <class Locals>
  void start(const Gains& g, std::size_t count, const Locals& local) {
    shares_.assign(count, 0);
    now_.resize(count);
    for (std::size_t k = 0; k < count; ++k)
      for (const int a : g.selection.entries(local(k).id)) shares_[k] |= static_cast<std::uint8_t>(1 << a);
  }

  /// What everybody shares at sample t, so many entries further on than at k = 0.
  void begin(const Gains& g, std::int64_t t) noexcept {
    const int offset = g.selection.offset(t - 1);
    // Bytes might be anything, also each other.
    const std::uint8_t* const __restrict__ first = shares_.data();
    std::uint8_t* const __restrict__ now = now_.data();
    const std::size_t count = shares_.size();
    for (std::size_t k = 0; k < count; ++k) now[k] = partial_sharing::shifted<n>(first[k], offset);
  }

  template <int B, class Wiring>
  GARRISON_INLINE void hear(const double* x, const Wiring& wiring, std::size_t begin, std::size_t end,
                            double* u) const noexcept {
    partial_sharing::Disagreement<n>::template run<B>(x, now_.data(), wiring, begin, end, u);
  }
  static void hear(const State<n>& s, const Inbox<Message<n>>& inbox, double* u) noexcept {
    disagreement<n>(s, inbox, u);
  }
  static void update(const Common& shared, Group& group, const double* u, double* next,
                     Outcome& outcome) noexcept {
    partial_sharing::update(shared, group, u, next, outcome);
  }

 private:
  std::vector<std::uint8_t> shares_;  // entries that each agent shares at k = 0
  std::vector<std::uint8_t> now_;     // and at this sample
};

}  // namespace garrison
