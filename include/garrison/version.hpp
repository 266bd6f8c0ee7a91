// SPDX-License-Identifier: Apache-2.0
// Which garrison: what a program was compiled with (macros), and what it runs with (function).
#pragma once

#include <string_view>

#include "garrison/core/error.hpp"

#define GARRISON_VERSION_MAJOR 0
#define GARRISON_VERSION_MINOR 1
#define GARRISON_VERSION_PATCH 0
#define GARRISON_VERSION "0.1.0"

namespace garrison {

/// Of the library that the program is linked with, e.g. "0.1.0"; before 1.0 a minor version may break its
/// users.
GARRISON_EXPORT std::string_view version() noexcept;

}  // namespace garrison
