// SPDX-License-Identifier: Apache-2.0
// BLAKE2b (RFC 7693), unkeyed: the fingerprint of designs and the checksum of snapshots. Keys, handshakes and
// signatures are libsodium's; this is here so that a node without it can still read its design.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "garrison/wire/bytes.hpp"

namespace garrison::wire {

using Digest = std::array<std::byte, 32>;

namespace detail {
inline constexpr std::uint64_t kIv[8] = {0x6a09e667f3bcc908, 0xbb67ae8584caa73b, 0x3c6ef372fe94f82b,
                                         0xa54ff53a5f1d36f1, 0x510e527fade682d1, 0x9b05688c2b3e6c1f,
                                         0x1f83d9abfb41bd6b, 0x5be0cd19137e2179};
inline constexpr std::uint8_t kSigma[10][16] = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
                                                {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
                                                {11, 8, 12, 0, 5, 2, 15, 13, 10, 14, 3, 6, 7, 1, 9, 4},
                                                {7, 9, 3, 1, 13, 12, 11, 14, 2, 6, 5, 10, 4, 0, 15, 8},
                                                {9, 0, 5, 7, 2, 4, 10, 15, 14, 1, 11, 12, 6, 8, 3, 13},
                                                {2, 12, 6, 10, 0, 11, 8, 3, 4, 13, 7, 5, 15, 14, 1, 9},
                                                {12, 5, 1, 15, 14, 13, 4, 10, 0, 7, 6, 3, 9, 2, 8, 11},
                                                {13, 11, 7, 14, 12, 1, 3, 9, 5, 0, 15, 4, 8, 6, 2, 10},
                                                {6, 15, 14, 9, 11, 3, 0, 8, 12, 2, 13, 7, 1, 4, 10, 5},
                                                {10, 2, 8, 4, 7, 6, 1, 5, 15, 11, 9, 14, 3, 12, 13, 0}};

/// F of section 3.2: one block of 128 bytes; `total` bytes were hashed with it.
inline void compress(std::uint64_t (&h)[8], const std::byte* block, std::uint64_t total, bool last) noexcept {
  std::uint64_t m[16];
  std::uint64_t v[16];
  for (std::size_t k = 0; k < 16; ++k) m[k] = load<std::uint64_t>(block + 8 * k);
  for (std::size_t k = 0; k < 8; ++k) {
    v[k] = h[k];
    v[k + 8] = kIv[k];
  }
  v[12] ^= total;
  if (last) v[14] = ~v[14];
  const auto mix = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d, std::uint64_t x,
                       std::uint64_t y) {
    v[a] += v[b] + x;
    v[d] = std::rotr(v[d] ^ v[a], 32);
    v[c] += v[d];
    v[b] = std::rotr(v[b] ^ v[c], 24);
    v[a] += v[b] + y;
    v[d] = std::rotr(v[d] ^ v[a], 16);
    v[c] += v[d];
    v[b] = std::rotr(v[b] ^ v[c], 63);
  };
  for (std::size_t round = 0; round < 12; ++round) {
    const auto& s = kSigma[round % 10];
    for (std::size_t k = 0; k < 4; ++k) mix(k, 4 + k, 8 + k, 12 + k, m[s[2 * k]], m[s[2 * k + 1]]);
    for (std::size_t k = 0; k < 4; ++k)
      mix(k, 4 + (k + 1) % 4, 8 + (k + 2) % 4, 12 + (k + 3) % 4, m[s[8 + 2 * k]], m[s[9 + 2 * k]]);
  }
  for (std::size_t k = 0; k < 8; ++k) h[k] ^= v[k] ^ v[k + 8];
}
}  // namespace detail

/// BLAKE2b-256.
inline Digest blake2b(std::span<const std::byte> bytes) noexcept {
  std::uint64_t h[8];
  std::copy(std::begin(detail::kIv), std::end(detail::kIv), h);
  h[0] ^= 0x01010000U ^ sizeof(Digest);
  std::size_t done = 0;
  while (bytes.size() - done > 128) {
    detail::compress(h, bytes.data() + done, done + 128, false);
    done += 128;
  }
  std::byte block[128] = {};
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(done), bytes.end(), block);
  detail::compress(h, block, bytes.size(), true);
  Digest digest;
  for (std::size_t k = 0; k < 4; ++k) store(digest.data() + 8 * k, h[k]);
  return digest;
}

/// The first eight bytes of it, as a number.
inline std::uint64_t checksum(std::span<const std::byte> bytes) noexcept {
  return load<std::uint64_t>(blake2b(bytes).data());
}

}  // namespace garrison::wire
