// SPDX-License-Identifier: Apache-2.0
// Errors of construction, design and files. The inner step of a filter never throws.
#pragma once

#include <stdexcept>
#include <string>

#if defined(__GNUC__)
#define GARRISON_EXPORT __attribute__((visibility("default")))
#else
#define GARRISON_EXPORT
#endif

namespace garrison {

/// Base of everything garrison throws. The message says which, got, expected, and what to do.
class GARRISON_EXPORT Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A number, shape, index or name that cannot be used (ValueError in Python).
class GARRISON_EXPORT InvalidInput : public Error {
 public:
  using Error::Error;
};

/// No parameters exist that meet what was asked.
class GARRISON_EXPORT DesignInfeasible : public Error {
 public:
  using Error::Error;
};

/// A file that cannot be read or written (OSError in Python).
class GARRISON_EXPORT IoError : public Error {
 public:
  using Error::Error;
};

/// Raises InvalidInput in one form: "<which>: got <got>, expected <expected>; <what to do>".
[[noreturn]] GARRISON_EXPORT void refuse(const std::string& which, const std::string& got,
                                         const std::string& expected, const std::string& advice = "");

/// A double as a person would type it: shortest form that reads back the same.
GARRISON_EXPORT std::string text(double value);

}  // namespace garrison
