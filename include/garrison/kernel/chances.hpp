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
};

/// Philox4x32-10 in B lanes, one 32-bit word in 64 bits each (see philox in core/random.hpp).
struct Happen {
  template <int B>
  GARRISON_INLINE static void run(const Random* random, std::int64_t time, const std::uint32_t* address,
                                  std::uint32_t index, std::uint64_t limit, std::size_t count,
                                  std::uint8_t* out) noexcept {
    using V = typename Words<B>::type;
    const V low = V{} + 0xFFFFFFFFU;
    std::size_t e = 0;
    for (; e + B <= count; e += B) {
      V c0 = V{} + static_cast<std::uint32_t>(time);
      V c1 = __builtin_convertvector(*reinterpret_cast<const typename Words<B>::half*>(address + e), V);
      V c2 = V{} + index;
      V c3 = V{} + random->stream();
      auto [k0, k1] = random->key();
      for (int round = 0; round < 10; ++round) {
        const V a = c0 * 0xD2511F53U;
        const V b = c2 * 0xCD9E8D57U;
        c0 = (b >> 32) ^ c1 ^ k0;
        c2 = (a >> 32) ^ c3 ^ k1;
        c1 = b & low;
        c3 = a & low;
        k0 += 0x9E3779B9U;
        k1 += 0xBB67AE85U;
      }
      const V bits = (c0 << 32 | c1) >> 11;
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
