// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/plan/consensus_kernel.hpp"

#include <cstddef>

#include "garrison/kernel/average.hpp"
#include "garrison/kernel/block.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison::kernel {
namespace {

/// B doubles at any address. Never deduced: a template argument loses the attribute that says so.
template <int B>
using Doubles = typename Block<B>::type;

/// Adds the rows of `count` neighbours.
template <int W, int B, int count>
GARRISON_INLINE void add(const double* now, const std::int32_t* e, Doubles<B>* sum) {
#pragma GCC unroll 4
  for (int j = 0; j < count; ++j) {
    const Doubles<B>* other = Block<B>::of(now + e[j]);
#pragma GCC unroll 8
    for (int k = 0; k < W / B; ++k) sum[k] += other[k];
  }
}

template <int W, int B, bool plain>
GARRISON_INLINE void finish(const Round& round, std::int32_t row, double degree, const Doubles<B>* sum) {
  const Doubles<B>* x = Block<B>::of(round.now + static_cast<std::ptrdiff_t>(row) * W);
  Doubles<B>* next = Block<B>::of(round.next + static_cast<std::ptrdiff_t>(row) * W);
#pragma GCC unroll 8
  for (int k = 0; k < W / B; ++k)
    next[k] = plain ? averaged_entry(x[k], sum[k], degree, round.alpha)
                    : averaged_entry(x[k], sum[k], degree, round.alpha, round.omega, next[k]);
}

/// `rest` = (degree - 1) % 4: after the first neighbour the loop takes four at a time, and its trip count
/// never changes.
template <int W, int most, bool plain, int rest>
GARRISON_INLINE void rows(const Round& round, const Run& run) {
  constexpr int B = block_of(W, most);
  constexpr int blocks = W / B;
  const std::int32_t* e = round.neighbour + run.edge;
  for (std::int32_t i = run.begin; i < run.end; ++i) {
    Doubles<B> sum[blocks];
    const Doubles<B>* first = Block<B>::of(round.now + *e++);
#pragma GCC unroll 8
    for (int k = 0; k < blocks; ++k) sum[k] = first[k];
    for (int fours = (run.degree - 1) / 4; fours > 0; --fours, e += 4) add<W, B, 4>(round.now, e, sum);
    add<W, B, rest>(round.now, e, sum);
    e += rest;
    finish<W, B, plain>(round, i, run.degree, sum);
  }
}

/// Agents without neighbours.
template <int W, int most, bool plain>
GARRISON_INLINE void lone_rows(const Round& round, const Run& run) {
  constexpr int B = block_of(W, most);
  for (std::int32_t i = run.begin; i < run.end; ++i) {
    Doubles<B> sum[W / B] = {};
    finish<W, B, plain>(round, i, 0.0, sum);
  }
}

template <int W, int most, bool plain>
GARRISON_INLINE void runs(const Round& round, const Run* first, const Run* last) {
  for (const Run* run = first; run != last; ++run) switch (run->degree == 0 ? 4 : (run->degree - 1) % 4) {
      case 0:
        rows<W, most, plain, 0>(round, *run);
        break;
      case 1:
        rows<W, most, plain, 1>(round, *run);
        break;
      case 2:
        rows<W, most, plain, 2>(round, *run);
        break;
      case 3:
        rows<W, most, plain, 3>(round, *run);
        break;
      default:
        lone_rows<W, most, plain>(round, *run);
    }
}

template <bool plain>
GARRISON_INLINE void runs_of_any_width(const Round& round, const Run* first, const Run* last, int width) {
  for (const Run* run = first; run != last; ++run) {
    const auto degree = static_cast<double>(run->degree);
    const std::int32_t* e = round.neighbour + run->edge;
    for (std::int32_t i = run->begin; i < run->end; ++i, e += run->degree)
      for (int k = 0; k < width; ++k) {
        double sum = run->degree > 0 ? round.now[e[0] + k] : 0.0;
        for (std::int32_t j = 1; j < run->degree; ++j) sum += round.now[e[j] + k];
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * width + k;
        round.next[at] =
            plain ? averaged_entry(round.now[at], sum, degree, round.alpha)
                  : averaged_entry(round.now[at], sum, degree, round.alpha, round.omega, round.next[at]);
      }
  }
}

template <int most, bool plain>
GARRISON_INLINE void dispatch(const Round& round, const Run* first, const Run* last, int width) {
  switch (width) {
    case 1:
      return runs<1, most, plain>(round, first, last);
    case 2:
      return runs<2, most, plain>(round, first, last);
    case 3:
      return runs<3, most, plain>(round, first, last);
    case 4:
      return runs<4, most, plain>(round, first, last);
    case 5:
      return runs<5, most, plain>(round, first, last);
    case 6:
      return runs<6, most, plain>(round, first, last);
    case 7:
      return runs<7, most, plain>(round, first, last);
    case 8:
      return runs<8, most, plain>(round, first, last);
    case 16:
      return runs<16, most, plain>(round, first, last);  // from here on: eight trials side by side
    case 24:
      return runs<24, most, plain>(round, first, last);
    case 32:
      return runs<32, most, plain>(round, first, last);
    case 40:
      return runs<40, most, plain>(round, first, last);
    case 48:
      return runs<48, most, plain>(round, first, last);
    case 56:
      return runs<56, most, plain>(round, first, last);
    case 64:
      return runs<64, most, plain>(round, first, last);
    default:
      return runs_of_any_width<plain>(round, first, last, width);
  }
}

struct AverageRuns {
  template <int most>
  GARRISON_INLINE static void run(const Round& round, const Run* first, const Run* last, int width) {
    if (round.omega == 1.0)
      dispatch<most, true>(round, first, last, width);
    else
      dispatch<most, false>(round, first, last, width);
  }
};

}  // namespace

void average_runs(const Round& round, const Run* first, const Run* last, int width) {
  run_widest<AverageRuns, const Round&>(round, first, last, width);
}

}  // namespace garrison::kernel
