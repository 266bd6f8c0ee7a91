// SPDX-License-Identifier: Apache-2.0
#include "consensus_kernel.hpp"

#include <cstddef>

#include "../core/clones.hpp"
#include "garrison/core/average.hpp"

namespace garrison::kernel {
namespace {

/// B doubles that are added and multiplied together; any alignment, any aliasing.
template <int B>
struct Block {
  typedef double type __attribute__((vector_size(B * sizeof(double)), aligned(sizeof(double)), may_alias));
};

/// Widest block that divides a row of W entries.
constexpr int block_of(int W) { return W % 8 == 0 ? 8 : W % 4 == 0 ? 4 : W % 2 == 0 ? 2 : 1; }

template <int W, bool plain>
GARRISON_INLINE void rows(const RowJob& job) {
  constexpr int B = block_of(W);
  constexpr int blocks = W / B;
  using V = typename Block<B>::type;
  for (std::int32_t i = job.begin; i < job.end; ++i) {
    V sum[blocks] = {};
    const std::int32_t* e = job.neighbour + job.first[i];
    const std::int32_t* const last = job.neighbour + job.first[i + 1];
    const auto degree = static_cast<double>(last - e);
    for (; e != last; ++e) {
      const V* other = reinterpret_cast<const V*>(job.now + static_cast<std::ptrdiff_t>(*e) * W);
#pragma GCC unroll 8
      for (int k = 0; k < blocks; ++k) sum[k] += other[k];
    }
    const V* x = reinterpret_cast<const V*>(job.now + static_cast<std::ptrdiff_t>(i) * W);
    V* next = reinterpret_cast<V*>(job.next + static_cast<std::ptrdiff_t>(i) * W);
#pragma GCC unroll 8
    for (int k = 0; k < blocks; ++k)
      next[k] = plain ? averaged_entry(x[k], sum[k], degree, job.alpha)
                      : averaged_entry(x[k], sum[k], degree, job.alpha, job.omega, next[k]);
  }
}

template <bool plain>
GARRISON_INLINE void rows_of_any_width(const RowJob& job, int width) {
  for (std::int32_t i = job.begin; i < job.end; ++i) {
    const auto degree = static_cast<double>(job.first[i + 1] - job.first[i]);
    for (int k = 0; k < width; ++k) {
      double sum = 0.0;
      for (std::int32_t e = job.first[i]; e < job.first[i + 1]; ++e)
        sum += job.now[static_cast<std::ptrdiff_t>(job.neighbour[e]) * width + k];
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * width + k;
      job.next[at] = plain ? averaged_entry(job.now[at], sum, degree, job.alpha)
                           : averaged_entry(job.now[at], sum, degree, job.alpha, job.omega, job.next[at]);
    }
  }
}

template <bool plain>
GARRISON_INLINE void dispatch(const RowJob& job, int width) {
  switch (width) {
    case 1:
      return rows<1, plain>(job);
    case 2:
      return rows<2, plain>(job);
    case 3:
      return rows<3, plain>(job);
    case 4:
      return rows<4, plain>(job);
    case 5:
      return rows<5, plain>(job);
    case 6:
      return rows<6, plain>(job);
    case 7:
      return rows<7, plain>(job);
    case 8:
      return rows<8, plain>(job);
    case 16:
      return rows<16, plain>(job);  // from here on: eight trials side by side
    case 24:
      return rows<24, plain>(job);
    case 32:
      return rows<32, plain>(job);
    case 40:
      return rows<40, plain>(job);
    case 48:
      return rows<48, plain>(job);
    case 56:
      return rows<56, plain>(job);
    case 64:
      return rows<64, plain>(job);
    default:
      return rows_of_any_width<plain>(job, width);
  }
}

}  // namespace

GARRISON_CLONES void average_rows(const RowJob& job, int width) {
  if (job.omega == 1.0)
    dispatch<true>(job, width);
  else
    dispatch<false>(job, width);
}

}  // namespace garrison::kernel
