// SPDX-License-Identifier: Apache-2.0
// Bytes with a few of them changed, lost, doubled or cut off: what every reader of files has to survive.
#pragma once

#include <random>
#include <string>

namespace garrison::node::test {

inline std::string mutated(std::string text, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random() % n); };
  for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
    const std::size_t at = below(text.size());
    switch (below(6)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, 1 + below(8));
        break;
      case 2:
        text.insert(at, text.substr(below(text.size()), below(40)));
        break;
      case 3:
        text.resize(at);
        break;
      case 4:
        text.insert(at, 1, "[]{}=\"'#\n,.-+@e:"[below(16)]);
        break;
      default:
        if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
    }
  }
  return text;
}

}  // namespace garrison::node::test
