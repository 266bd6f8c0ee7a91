// SPDX-License-Identifier: Apache-2.0
// Errors of construction, design and files. The inner step of a filter never throws.
#pragma once

#include <concepts>
#include <stdexcept>
#include <string>
#include <vector>

#if defined(__GNUC__)
#define GARRISON_EXPORT __attribute__((visibility("default")))
#else
#define GARRISON_EXPORT
#endif

namespace garrison {

/// Base of everything garrison throws. The message says which, got, expected, and what to do.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A number, shape, index or name that cannot be used (ValueError in Python).
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT InvalidInput : public Error {
 public:
  using Error::Error;
};

/// No parameters exist that meet what was asked.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT DesignInfeasible : public Error {
 public:
  using Error::Error;
};

/// A file that cannot be read or written (OSError in Python).
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT IoError : public Error {
 public:
  using Error::Error;
};

/// Raises InvalidInput in one form: "<which>: got <got>, expected <expected>; <what to do>".
[[noreturn]] GARRISON_EXPORT void refuse(const std::string& which, const std::string& got,
                                         const std::string& expected, const std::string& advice = "");

/// Refuses an empty name or one that occurs twice, and another number of names than `count` (none at all is
/// fine); `owners` says what has them.
GARRISON_EXPORT void require_names(const std::string& which, const std::vector<std::string>& names,
                                   std::size_t count, const std::string& owners);
/// Refuses a result of more than memory_limit() bytes before anything is allocated; `size` is what the caller
/// asked for.
GARRISON_EXPORT void require_memory(const std::string& which, const std::string& size, double bytes);
/// Half of the machine's memory, or $GARRISON_MEMORY_GB.
GARRISON_EXPORT double memory_limit();

/// A double as a person would type it: shortest form that reads back the same.
GARRISON_EXPORT std::string text(double value);

/// "1 number", "3 numbers"; `many` where that is not `one` and an s.
template <std::integral Count>
std::string amount(Count count, const std::string& one, const std::string& many = "") {
  return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}

}  // namespace garrison
