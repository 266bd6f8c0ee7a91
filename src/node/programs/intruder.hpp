// SPDX-License-Identifier: Apache-2.0
// Somebody who sees every datagram and has no key: what he may send.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace garrison::node {

class Intruder {
 public:
  using Chance = std::mt19937_64;

  void remember(Chance& chance, const std::string& seen) {
    if (captured_.size() < kMost)
      captured_.push_back(seen);
    else
      captured_[chance() % kMost] = seen;
  }
  bool remembers() const { return !captured_.empty(); }
  /// A datagram of anybody to anybody, of any age.
  const std::string& old(Chance& chance) const { return captured_[chance() % captured_.size()]; }

  /// A genuine header before random bytes of the same length.
  static std::string forged(Chance& chance, const std::string& seen) {
    const std::size_t kept = std::min(seen.size(), kOuter);
    return seen.substr(0, kept) + junk(chance, seen.size() - kept);
  }
  /// Another length, another counter or one other bit: never the datagram itself.
  static std::string mutant(Chance& chance, std::string bytes) {
    const std::size_t at = bytes.empty() ? 0 : chance() % bytes.size();
    switch (chance() % 4) {
      case 0:
        return bytes.substr(0, at);
      case 1:
        return bytes + junk(chance, 1 + chance() % 16);
      case 2:
        if (bytes.size() >= kOuter) ++bytes[8 + chance() % 8];
        return bytes;
      default:
        if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << chance() % 8));
        return bytes;
    }
  }
  static std::string junk(Chance& chance, std::size_t size) {
    std::string out(size, '\0');
    for (char& c : out) c = static_cast<char>(chance());
    return out;
  }

 private:
  static constexpr std::size_t kMost = 20'000;
  static constexpr std::size_t kOuter = 16;  // the readable header of a data frame

  std::vector<std::string> captured_;
};

}  // namespace garrison::node
