// SPDX-License-Identifier: Apache-2.0
// How often a thread took memory from the heap.
#pragma once

#include <cstdint>

namespace garrison::node::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kAllocationsCounted = false;
#else
inline constexpr bool kAllocationsCounted = true;
#endif
/// Of the calling thread, since it began. Under sanitizers, which have a heap of their own, always 0.
std::int64_t allocations() noexcept;

}  // namespace garrison::node::test
