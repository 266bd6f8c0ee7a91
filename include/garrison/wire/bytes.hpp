// SPDX-License-Identifier: Apache-2.0
// Numbers as bytes: little-endian, IEEE binary64 bits, the same on every processor.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace garrison::wire {

static_assert(std::numeric_limits<double>::is_iec559);

// The loops are for big-endian processors: compilers do not turn them into one access everywhere.

template <class Unsigned>
void store(std::byte* at, Unsigned value) noexcept {
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(at, &value, sizeof(Unsigned));
    return;
  }
  for (std::size_t k = 0; k < sizeof(Unsigned); ++k) at[k] = static_cast<std::byte>(value >> (8 * k));
}
template <class Unsigned>
Unsigned load(const std::byte* at) noexcept {
  Unsigned value = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(&value, at, sizeof(Unsigned));
    return value;
  }
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
