// SPDX-License-Identifier: Apache-2.0
// Numbers as bytes: little-endian, IEEE binary64 bits, the same on every processor.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace garrison::wire {

static_assert(std::numeric_limits<double>::is_iec559);

template <class Unsigned>
void store(std::byte* at, Unsigned value) noexcept {
  for (std::size_t k = 0; k < sizeof(Unsigned); ++k) at[k] = static_cast<std::byte>(value >> (8 * k));
}
template <class Unsigned>
Unsigned load(const std::byte* at) noexcept {
  Unsigned value = 0;
  for (std::size_t k = 0; k < sizeof(Unsigned); ++k)
    value |= static_cast<Unsigned>(static_cast<Unsigned>(std::to_integer<std::uint8_t>(at[k])) << (8 * k));
  return value;
}
inline void store_double(std::byte* at, double value) noexcept {
  store(at, std::bit_cast<std::uint64_t>(value));
}
inline double load_double(const std::byte* at) noexcept {
  return std::bit_cast<double>(load<std::uint64_t>(at));
}

/// The only NaN that stands for an absent number.
inline constexpr std::uint64_t kAbsent = 0x7ff8000000000000U;

}  // namespace garrison::wire
