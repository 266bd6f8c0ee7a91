// SPDX-License-Identifier: Apache-2.0
// Counts of samples in a row.
#pragma once

#include <cstdint>

namespace garrison {

/// One more, or the largest number: a node counts for years, and a snapshot may say anything.
constexpr int one_more(int count) noexcept { return count < INT32_MAX ? count + 1 : count; }

}  // namespace garrison
