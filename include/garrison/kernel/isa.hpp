// SPDX-License-Identifier: Apache-2.0
// One kernel source, compiled for several instruction sets, picked when the program runs.
#pragma once

#include <utility>

#define GARRISON_INLINE __attribute__((always_inline)) inline
/// The same for a lambda.
#define GARRISON_INLINED __attribute__((always_inline))

#if defined(__x86_64__) && defined(__GNUC__)
#define GARRISON_TARGET(isa) __attribute__((target(isa)))
#else
#define GARRISON_TARGET(isa)
#endif

namespace garrison {

namespace detail {
template <class Kernel, class... Args>
GARRISON_TARGET("avx512f,avx512dq,avx512vl")
void run_eight(Args... args) {
  Kernel::template run<8>(args...);
}
template <class Kernel, class... Args>
GARRISON_TARGET("avx2")
void run_four(Args... args) {
  Kernel::template run<4>(args...);
}
template <class Kernel, class... Args>
__attribute__((noinline)) void run_two(Args... args) {
  Kernel::template run<2>(args...);
}

/// Doubles in the widest register of this machine that we have kernels for.
inline int register_doubles() {
#if defined(__x86_64__) && defined(__GNUC__)
  // With masks for vectors of any width; only the first machines with 512 bits lacked these.
  static const bool eight = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                            __builtin_cpu_supports("avx512vl");
  static const int doubles = eight ? 8 : __builtin_cpu_supports("avx2") ? 4 : 2;
  return doubles;
#else
  return 2;
#endif
}
}  // namespace detail

/// Kernel::run<B>(args...), which must be GARRISON_INLINE, with B doubles per vector as this machine has
/// them. Explicit vectors must not be wider: gcc splits those into parts that it takes to be aligned.
template <class Kernel, class... Args>
void run_widest(Args... args) {
  switch (detail::register_doubles()) {
    case 8:
      return detail::run_eight<Kernel>(args...);
    case 4:
      return detail::run_four<Kernel>(args...);
    default:
      return detail::run_two<Kernel>(args...);
  }
}

/// The same for kernels of rows of n numbers: other rows than of 4 or 8 do not fill wide registers, and run
/// two by two.
template <class Kernel, int n, class... Args>
void run_widest_of(Args... args) {
  if constexpr (n % 4 == 0)
    run_widest<Kernel>(args...);
  else
    detail::run_two<Kernel>(args...);
}

/// From inside a kernel of B doubles, another one of as many: called where inlining would compile it twice.
template <class Kernel, int B, class... Args>
void run_as_wide(Args... args) {
  if constexpr (B == 8)
    detail::run_eight<Kernel>(args...);
  else if constexpr (B == 4)
    detail::run_four<Kernel>(args...);
  else
    detail::run_two<Kernel>(args...);
}

}  // namespace garrison
