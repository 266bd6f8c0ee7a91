// SPDX-License-Identifier: Apache-2.0
// Independent events of one probability, many at once.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "garrison/core/random.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison {

namespace detail {
template <int B>
struct Words {
  typedef std::uint64_t type __attribute__((vector_size(B * 8)));
  typedef std::uint32_t half __attribute__((vector_size(B * 4), aligned(4), may_alias));
  // The same bits, as gcc's instructions have them.
  typedef int halves __attribute__((vector_size(B * 8)));
  typedef long long with_sign __attribute__((vector_size(B * 8)));
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // no vector crosses a call, everything is inlined
/// a = the lower half of a, times `factor`: one instruction, which gcc, unlike clang, does not find by
/// itself.
template <int B>
GARRISON_INLINE void multiply_half(typename Words<B>::type& a, std::uint32_t factor) {
  using V = typename Words<B>::type;
  const V b = V{} + factor;
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  using Halves = typename Words<B>::halves;
  const auto x = reinterpret_cast<Halves>(a);
  const auto y = reinterpret_cast<Halves>(b);
  if constexpr (B == 8)
    a = reinterpret_cast<V>(__builtin_ia32_pmuludq512_mask(x, y, typename Words<B>::with_sign{}, 0xFF));
  else if constexpr (B == 4)
    a = reinterpret_cast<V>(__builtin_ia32_pmuludq256(x, y));
  else
    a = reinterpret_cast<V>(__builtin_ia32_pmuludq128(x, y));
#else
  a = (a & 0xFFFFFFFFU) * b;
#endif
}
#pragma GCC diagnostic pop

/// Philox4x32-10 in B lanes, one 32-bit word in the lower half of 64 bits each, whatever the upper half (see
/// philox in core/random.hpp).
struct Happen {
  template <int B>
  GARRISON_INLINE static void run(const Random* random, std::int64_t time, const std::uint32_t* address,
                                  std::uint32_t index, std::uint64_t limit, std::size_t count,
                                  std::uint8_t* out) noexcept {
    using V = typename Words<B>::type;
    constexpr int rounds = 10;
    V k0[rounds];
    V k1[rounds];
    for (int round = 0; round < rounds; ++round) {
      const auto r = static_cast<std::uint32_t>(round);
      k0[round] = V{} + (random->key()[0] + r * 0x9E3779B9U);
      k1[round] = V{} + (random->key()[1] + r * 0xBB67AE85U);
    }
    std::size_t e = 0;
    for (; e + B <= count; e += B) {
      V c0 = V{} + static_cast<std::uint32_t>(time);
      V c1 = __builtin_convertvector(*reinterpret_cast<const typename Words<B>::half*>(address + e), V);
      V c2 = V{} + index;
      V c3 = V{} + random->stream();
      for (int round = 0; round < rounds; ++round) {
        multiply_half<B>(c0, 0xD2511F53U);
        multiply_half<B>(c2, 0xCD9E8D57U);
        const V next = (c2 >> 32) ^ c1 ^ k0[round];
        c1 = c2;
        c2 = (c0 >> 32) ^ c3 ^ k1[round];
        c3 = c0;
        c0 = next;
      }
      const V bits = (c0 << 32 | (c1 & 0xFFFFFFFFU)) >> 11;
      for (int lane = 0; lane < B; ++lane) out[e + static_cast<std::size_t>(lane)] = bits[lane] < limit;
    }
    for (; e < count; ++e)
      out[e] = random->uniform(time, address[e], index) < std::ldexp(static_cast<double>(limit), -53);
  }
};
}  // namespace detail

/// out[e] = random.uniform(time, address[e], index) < probability, which is in [0, 1].
inline void happen(const Random& random, std::int64_t time, const std::uint32_t* address, std::uint32_t index,
                   double probability, std::size_t count, std::uint8_t* out) noexcept {
  // uniform is a whole number of 2^-53.
  const auto limit = static_cast<std::uint64_t>(std::ceil(std::ldexp(probability, 53)));
  run_widest<detail::Happen>(&random, time, address, index, limit, count, out);
}

}  // namespace garrison
