// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/error.hpp"

#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace garrison {
namespace {

std::string gigabytes(double bytes) {
  std::array<char, 32> words{};
  std::snprintf(words.data(), words.size(), "%.3g GB", bytes / 1e9);
  return words.data();
}

}  // namespace

namespace {
/// A zero would end a message, and a terminal would obey what else may stand in somebody's file.
std::string printable(const std::string& given) {
  std::string out;
  for (const char c : given) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7f) {
      out += c;
      continue;
    }
    constexpr const char* digits = "0123456789abcdef";
    out.append("\\x") += digits[byte >> 4U];
    out += digits[byte & 15U];
  }
  return out;
}
}  // namespace

void refuse(const std::string& which, const std::string& got, const std::string& expected,
            const std::string& advice) {
  std::string message = which;
  message.append(": got ").append(printable(got)).append(", expected ").append(expected);
  if (!advice.empty()) message.append("; ").append(advice);
  throw InvalidInput(message);
}

void require_names(const std::string& which, const std::vector<std::string>& names, std::size_t count,
                   const std::string& owners) {
  if (!names.empty() && names.size() != count)
    refuse(which, amount(names.size(), "name"), std::to_string(count) + ", one per " + owners);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) refuse(which + "[" + std::to_string(i) + "]", "an empty name", "a name");
    if (!seen.insert(names[i]).second)
      refuse(which + "[" + std::to_string(i) + "]", "\"" + names[i] + "\" once more", "different names");
  }
}

double memory_limit() {
  constexpr double gigabyte = 1e9;
  if (const char* given = std::getenv("GARRISON_MEMORY_GB")) {
    char* end = nullptr;
    const double value = std::strtod(given, &end);
    if (end == given || *end != '\0' || !(value > 0.0))
      refuse("GARRISON_MEMORY_GB", std::string("\"") + given + "\"", "a number of gigabytes > 0");
    return value * gigabyte;
  }
  static const double half =
      0.5 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return half;
}

void require_memory(const std::string& which, const std::string& size, double bytes) {
  if (bytes <= memory_limit()) return;
  refuse(which, size + ", which takes " + gigabytes(bytes),
         "at most " + gigabytes(memory_limit()) + ", half of this machine's memory",
         "set GARRISON_MEMORY_GB to allow more");
}

std::string text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace garrison
