// SPDX-License-Identifier: Apache-2.0
// The parsers of a node, as targets of a fuzzer: whatever the bytes, they are taken or refused.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace garrison::node::test {

struct Target {
  /// Whether the bytes were taken. Anything but taking and a garrison::Error is a bug.
  std::function<bool(const std::string& bytes)> parse;
  std::vector<std::string> seeds;  ///< genuine ones
};

const std::vector<std::string>& target_names();
/// Null for another name.
std::unique_ptr<Target> target_of(const std::string& name);

}  // namespace garrison::node::test
