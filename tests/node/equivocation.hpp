// SPDX-License-Identifier: Apache-2.0
// What a liar with keys shows to half of its neighbours: another statement about the same samples.
#pragma once

#include "garrison/node/frame.hpp"
#include "garrison/node/statement.hpp"

namespace garrison::node::test {

/// Whether `plain` (inner header and body) was a statement of `own`, and is another genuine one now.
inline bool state_otherwise(Room plain, std::size_t size, int own, const Key& run,
                            const SigningKey& key) noexcept {
  if (size < kInner + Statement::kSize || Inner::read(plain.data()).kind != Kind::statement) return false;
  auto said = Statement::read(Bytes(plain).subspan(kInner, Statement::kSize));
  if (!said || said->sender != own) return false;
  said->digest[0] ^= std::byte{1};
  sign(*said, run, key);
  said->write(plain.data() + kInner);
  return true;
}

}  // namespace garrison::node::test
