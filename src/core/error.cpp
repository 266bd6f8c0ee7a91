// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/error.hpp"

#include <array>
#include <charconv>

namespace garrison {

void refuse(const std::string& which, const std::string& got, const std::string& expected,
            const std::string& advice) {
  std::string message = which;
  message.append(": got ").append(got).append(", expected ").append(expected);
  if (!advice.empty()) message.append("; ").append(advice);
  throw InvalidInput(message);
}

std::string text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace garrison
