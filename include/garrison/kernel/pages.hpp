// SPDX-License-Identifier: Apache-2.0
// Memory of large result arrays.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace garrison {

/// Zeros from the system, which are touched only when they are written: a run's results are as large as its
/// work is long, so writing them twice, or page by small page, would cost as much as the filter itself.
template <class T>
struct ZeroPages {
  using value_type = T;

  T* allocate(std::size_t count) {
    void* p = std::calloc(count, sizeof(T));
    if (p == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    constexpr std::size_t kPage = std::size_t{1} << 21;
    const auto begin = reinterpret_cast<std::size_t>(p);
    const std::size_t aligned = (begin + kPage - 1) / kPage * kPage;
    const std::size_t end = (begin + count * sizeof(T)) / kPage * kPage;
    if (aligned < end) madvise(reinterpret_cast<void*>(aligned), end - aligned, MADV_HUGEPAGE);  // a hint
#endif
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t) noexcept { std::free(p); }

  /// Fresh memory is zero already. (Growing a vector that has shrunk would show its old numbers again.)
  template <class U>
  void construct(U*) noexcept {}
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  bool operator==(const ZeroPages&) const { return true; }
};

/// A large array of plain numbers that is sized once.
template <class T>
using Bulk = std::vector<T, ZeroPages<T>>;

}  // namespace garrison
