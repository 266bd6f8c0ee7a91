// SPDX-License-Identifier: Apache-2.0
// What stands where a file is expected.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace garrison::mpi {

/// What is at `path` in place of a plain file, whose words a refusal goes on with: a pipe would be waited for
/// for ever. Empty: a plain file, or nothing.
inline std::string not_a_file(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) return "a folder";
  const bool other = std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none);
  return other ? "no plain file" : "";
}

}  // namespace garrison::mpi
