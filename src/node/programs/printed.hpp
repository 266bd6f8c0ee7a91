// SPDX-License-Identifier: Apache-2.0
// What a program has printed has arrived, or its end says that it has not.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace garrison::node {

/// `code`, or 2 with a word where standard output did not take everything.
inline int printed(const char* program, int code) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written) return code;
  std::fprintf(stderr, "%s: standard output: got %s, expected one that takes what is printed\n", program,
               std::strerror(errno));
  return 2;
}

}  // namespace garrison::node
