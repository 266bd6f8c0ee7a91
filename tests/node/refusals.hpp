// SPDX-License-Identifier: Apache-2.0
// What a refusal says.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>

#include "garrison/core/error.hpp"

namespace garrison::node::test {

/// The words of what a call refuses; empty = it does not.
template <class Call>
std::string refused(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline bool says(const std::string& message, std::initializer_list<const char*> parts) {
  return std::all_of(parts.begin(), parts.end(),
                     [&](const char* part) { return message.find(part) != std::string::npos; });
}

}  // namespace garrison::node::test
