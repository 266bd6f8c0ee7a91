// SPDX-License-Identifier: Apache-2.0
// One number for the bits of all estimates of a run, whoever has them.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace garrison::mpi {

inline std::uint64_t mixed(std::uint64_t z) {  // splitmix64
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}
/// Of the estimate of one agent at one sample; the sum over all of them, modulo 2^64, is that of a run.
inline std::uint64_t hash_of(std::span<const double> estimate, std::int64_t t, int agent) {
  std::uint64_t sum = 0;
  std::uint64_t key = mixed(mixed(static_cast<std::uint64_t>(t)) ^ static_cast<std::uint32_t>(agent));
  for (const double x : estimate) sum += mixed(std::bit_cast<std::uint64_t>(x) ^ (key = mixed(key)));
  return sum;
}

}  // namespace garrison::mpi
