// SPDX-License-Identifier: Apache-2.0
// Bytes as libsodium takes them.
#pragma once

#include "garrison/node/bytes.hpp"

namespace garrison::node {

inline const unsigned char* octets(const std::byte* bytes) noexcept {
  return reinterpret_cast<const unsigned char*>(bytes);
}
inline unsigned char* octets(std::byte* bytes) noexcept { return reinterpret_cast<unsigned char*>(bytes); }
template <class Container>
auto octets(Container&& bytes) noexcept {
  return octets(bytes.data());
}

}  // namespace garrison::node
