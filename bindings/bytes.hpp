// SPDX-License-Identifier: Apache-2.0
// Bytes between Python and C++.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bindings.hpp"

inline py::bytes to_python(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Any object with a buffer of bytes.
std::vector<std::byte> from_python(const py::object& given, const char* which);

inline std::string hex(std::span<const std::byte> bytes) {
  return to_python(bytes).attr("hex")().cast<std::string>();
}
