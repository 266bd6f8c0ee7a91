// SPDX-License-Identifier: Apache-2.0
// Messages between ranks of one run: the bits that are in memory, whatever they say. Unlike the wire form
// (wire/message.hpp) nothing is refused: a number that is not finite has to arrive as such, because what
// becomes of a message is decided where it is received.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>

#include "garrison/core/fields.hpp"

namespace garrison::partition {
namespace detail {

/// Copies every field of a message from its bytes or to them; `at` null: counts only.
template <bool read>
struct Raw : NumbersOf<Raw<read>> {
  std::byte* at = nullptr;
  std::size_t used = 0;

  using NumbersOf<Raw<read>>::numbers;
  using NumbersOf<Raw<read>>::sparse;
  void numbers(std::string_view, std::span<double> values) { copy(values.data(), values.size_bytes()); }
  void sparse(std::string_view, std::span<double> values) { copy(values.data(), values.size_bytes()); }
  void optional(std::string_view, double& value) { copy(&value, sizeof value); }
  void count(std::string_view, int& value, int) { copy(&value, sizeof value); }
  void flag(std::string_view, bool& value) {
    char byte = value ? 1 : 0;
    copy(&byte, 1);
    if constexpr (read) value = byte != 0;
  }
  void set(std::string_view, AgentSet& value) {
    if constexpr (read) {
      if (at != nullptr) value.clear();
    }
    for (int k = 0; k < 8 * static_cast<int>(value.words()); ++k) {
      std::uint8_t byte = value.byte(k);
      copy(&byte, 1);
      if constexpr (read) value.set_byte(k, byte);
    }
  }

 private:
  void copy(void* value, std::size_t bytes) {
    if (at != nullptr && bytes > 0) {
      if constexpr (read)
        std::memcpy(value, at + used, bytes);
      else
        std::memcpy(at + used, value, bytes);
    }
    used += bytes;
  }
};

}  // namespace detail

/// Bytes of a message; the same for all messages of a family that hold as many numbers.
template <class Message>
std::size_t raw_size(const Message& message) {
  detail::Raw<false> look;
  const_cast<Message&>(message).visit(look);  // only read
  return look.used;
}
template <class Message>
void write_raw(const Message& message, std::byte* out) {
  detail::Raw<false> raw;
  raw.at = out;
  const_cast<Message&>(message).visit(raw);  // only read
}
/// Into a message of the same shape.
template <class Message>
void read_raw(const std::byte* in, Message& message) {
  detail::Raw<true> raw;
  raw.at = const_cast<std::byte*>(in);
  message.visit(raw);
}

}  // namespace garrison::partition
