// SPDX-License-Identifier: Apache-2.0
// A message's body, from the list of its fields (core/fields.hpp): canonical, so that equal messages are
// equal bytes, and total, so that any bytes are either a message or refused by name.
//
//   numbers, optional  binary64, little-endian; NaN only in an optional, and only 0x7ff8000000000000
//   sparse             ceil(size/8) bytes, a bit for each number that is present, then these as binary64
//   flag               one byte, 0 or 1
//   count              u16, 0..most
//   set                ceil(N/8) bytes, bits beyond N zero; nothing where the family keeps no such set
//   labels             u16 2 * listed + complement, then u16 ids, strictly ascending, < N
//
// Sender, sample and round are not in it: they are the driver's (core/envelope.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "garrison/core/envelope.hpp"
#include "garrison/core/fields.hpp"
#include "garrison/wire/bytes.hpp"

namespace garrison::wire {

/// Counts the bytes of a body: of what its sets hold now, and the most they may hold.
/// Threads: one at a time.
class Size : public NumbersOf<Size> {
 public:
  explicit Size(int agents) : agents_(agents) {}
  std::size_t now() const { return now_; }
  std::size_t most() const { return most_; }

  using NumbersOf<Size>::numbers;
  using NumbersOf<Size>::sparse;
  void sparse(std::string_view, std::span<double> values) {
    const std::size_t bits = (values.size() + 7) / 8;
    now_ += bits;
    most_ += bits + 8 * values.size();
    for (const double v : values) now_ += std::isnan(v) ? 0U : 8U;
  }
  void numbers(std::string_view, std::span<double> values) { add(8 * values.size()); }
  void optional(std::string_view, double&) { add(8); }
  void flag(std::string_view, bool&) { add(1); }
  void count(std::string_view, int&, int) { add(2); }
  void set(std::string_view, AgentSet& set) {
    add(set.empty() ? 0 : (static_cast<std::size_t>(agents_) + 7) / 8);
  }
  void labels(std::string_view, LabelSet& set) {
    now_ += 2 + 2 * static_cast<std::size_t>(set.count());
    most_ += 2 + 2 * static_cast<std::size_t>(set.capacity());
  }

 private:
  void add(std::size_t bytes) {
    now_ += bytes;
    most_ += bytes;
  }
  int agents_;
  std::size_t now_ = 0;
  std::size_t most_ = 0;
};

/// Writes fields one behind the other; there must be room (Size::most).
/// Threads: one at a time.
class Encoder : public NumbersOf<Encoder> {
 public:
  Encoder(std::byte* out, int agents) : begin_(out), at_(out), agents_(agents) {}
  std::size_t written() const { return static_cast<std::size_t>(at_ - begin_); }

  using NumbersOf<Encoder>::numbers;
  using NumbersOf<Encoder>::sparse;
  void sparse(std::string_view, std::span<double> values) {
    std::byte* number = at_ + (values.size() + 7) / 8;
    for (std::size_t first = 0; first < values.size(); first += 8) {
      unsigned bits = 0;
      for (std::size_t k = first; k < values.size() && k < first + 8; ++k) {
        if (std::isnan(values[k])) continue;
        bits |= 1U << (k - first);
        store_double(number, values[k]);
        number += 8;
      }
      put(static_cast<std::uint8_t>(bits));
    }
    at_ = number;
  }
  void numbers(std::string_view, std::span<double> values) {
    for (const double v : values) put_double(v);
  }
  void optional(std::string_view, double& value) {
    if (std::isnan(value))
      put(kAbsent);
    else
      put_double(value);
  }
  void flag(std::string_view, bool& value) { put<std::uint8_t>(value ? 1 : 0); }
  void count(std::string_view, int& value, int) { put(static_cast<std::uint16_t>(value)); }
  void set(std::string_view, AgentSet& set) {
    if (set.empty()) return;
    for (int first = 0; first < agents_; first += 8) put(set.byte(first / 8));
  }
  void labels(std::string_view, LabelSet& set) {
    put(static_cast<std::uint16_t>(2 * set.count() + (set.complement() ? 1 : 0)));
    for (const int id : set.listed()) put(static_cast<std::uint16_t>(id));
  }

 private:
  template <class Unsigned>
  void put(Unsigned value) {
    store(at_, value);
    at_ += sizeof(Unsigned);
  }
  void put_double(double value) {
    store_double(at_, value);
    at_ += 8;
  }
  std::byte* begin_;
  std::byte* at_;
  int agents_;
};

/// Reads fields into a message whose vectors and sets have their sizes already. After the first refusal
/// nothing more is read, and what was read is not to be used.
/// Threads: one at a time.
class Decoder : public NumbersOf<Decoder> {
 public:
  Decoder(std::span<const std::byte> body, int agents)
      : at_(body.data()), end_(body.data() + body.size()), agents_(agents) {}
  /// Whether the body ends here, nothing of it refused.
  bool at_end() const { return refusal_ == Refusal::none && at_ == end_; }
  void refuse_as(Refusal why) { refusal_ = why; }
  /// Once all fields are visited: whether the body was a message, to its last byte.
  Refusal end() const {
    if (refusal_ != Refusal::none) return refusal_;
    return at_ == end_ ? Refusal::none : Refusal::size;
  }

  using NumbersOf<Decoder>::numbers;
  using NumbersOf<Decoder>::sparse;
  void sparse(std::string_view, std::span<double> values) {
    if (values.size() <= 8)
      few(values);
    else
      many(values);
  }
  void numbers(std::string_view, std::span<double> values) {
    if (!has(8 * values.size())) return;
    for (double& v : values) {
      v = load_double(at_);
      at_ += 8;
      if (!(std::abs(v) < kHuge)) return refuse_as(Refusal::number);
    }
  }
  void optional(std::string_view, double& value) {
    if (!has(8)) return;
    const auto bits = load<std::uint64_t>(at_);
    at_ += 8;
    value = bits == kAbsent ? kNaN : std::bit_cast<double>(bits);
    if (bits != kAbsent && !(std::abs(value) < kHuge)) refuse_as(Refusal::number);
  }
  void flag(std::string_view, bool& value) {
    if (!has(1)) return;
    const auto byte = std::to_integer<std::uint8_t>(*at_++);
    if (byte > 1) return refuse_as(Refusal::flag);
    value = byte == 1;
  }
  void count(std::string_view, int& value, int most) {
    if (!has(2)) return;
    value = take16();
    if (value > most) refuse_as(Refusal::flag);
  }
  void set(std::string_view, AgentSet& set) {
    if (set.empty()) return;
    const int bytes = (agents_ + 7) / 8;
    if (!has(static_cast<std::size_t>(bytes))) return;
    set.clear();
    for (int k = 0; k < bytes; ++k) set.set_byte(k, std::to_integer<std::uint8_t>(*at_++));
    const int beyond = 8 * bytes - agents_;
    if (beyond > 0 && (set.byte(bytes - 1) >> (8 - beyond)) != 0) refuse_as(Refusal::set);
  }
  void labels(std::string_view, LabelSet& set) {
    if (!has(2)) return;
    const int head = take16();
    const int listed = head / 2;
    if (listed > set.capacity() || (set.capacity() == 0 && head != 0)) return refuse_as(Refusal::set);
    if (!has(2 * static_cast<std::size_t>(listed))) return;
    set.start(listed, (head & 1) != 0);
    int last = -1;
    for (int k = 0; k < listed; ++k) {
      const int id = take16();
      if (id <= last || id >= agents_) return refuse_as(Refusal::set);
      set.place(k, id);
      last = id;
    }
  }

 private:
  /// Sparse numbers whose bits are one byte: those of most messages, and then often all there or none.
  void few(std::span<double> values) {
    if (values.empty() || !has(1)) return;
    const auto bits = std::to_integer<unsigned>(*at_);
    const unsigned whole = (1U << values.size()) - 1U;
    if (bits > whole) return refuse_as(Refusal::set);
    if (!has(1 + 8 * ones(bits))) return;
    ++at_;
    bool fine = true;
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = kNaN;
      if ((bits >> k & 1U) == 0) continue;
      values[k] = load_double(at_);
      fine &= std::abs(values[k]) < kHuge;
      at_ += 8;
    }
    if (!fine) refuse_as(Refusal::number);
  }
  /// Sparse numbers of any size.
  void many(std::span<double> values) {
    const std::size_t bytes = (values.size() + 7) / 8;
    if (!has(bytes)) return;
    const std::byte* const bits = at_;
    at_ += bytes;
    const std::size_t beyond = 8 * bytes - values.size();
    if (beyond > 0 && std::to_integer<unsigned>(bits[bytes - 1]) >> (8 - beyond) != 0)
      return refuse_as(Refusal::set);
    bool fine = true;
    std::fill(values.begin(), values.end(), kNaN);
    for (std::size_t first = 0; first < bytes; first += 8) {
      std::uint64_t rest = word(bits, first, bytes);
      if (!has(8 * ones(rest))) return;
      for (; rest != 0; rest &= rest - 1) {
        double& value = values[8 * first + static_cast<std::size_t>(std::countr_zero(rest))];
        value = load_double(at_);
        fine &= std::abs(value) < kHuge;
        at_ += 8;
      }
    }
    if (!fine) refuse_as(Refusal::number);
  }
  /// Up to eight bytes as a word, the first one in the lowest bits.
  static std::uint64_t word(const std::byte* bits, std::size_t first, std::size_t bytes) {
    std::uint64_t all = 0;
    for (std::size_t k = 0; k < 8 && first + k < bytes; ++k)
      all |= std::to_integer<std::uint64_t>(bits[first + k]) << (8 * k);
    return all;
  }
  /// Bits that are set; without a call, which std::popcount is on the oldest processors.
  static constexpr std::size_t ones(std::uint64_t bits) {
    bits -= bits >> 1 & 0x5555555555555555U;
    bits = (bits & 0x3333333333333333U) + (bits >> 2 & 0x3333333333333333U);
    return ((bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fU) * 0x0101010101010101U >> 56;
  }
  int take16() {
    const int value = load<std::uint16_t>(at_);
    at_ += 2;
    return value;
  }
  bool has(std::size_t bytes) {
    if (refusal_ != Refusal::none) return false;
    if (static_cast<std::size_t>(end_ - at_) >= bytes) return true;
    refuse_as(Refusal::size);
    return false;
  }

  const std::byte* at_;
  const std::byte* end_;
  int agents_;
  Refusal refusal_ = Refusal::none;
};

/// Bytes of a body as the message is now.
template <class Message>
std::size_t size(const Message& message, int agents) {
  Size size(agents);
  const_cast<Message&>(message).visit(size);  // only read
  return size.now();
}
/// The most bytes that a body of this family may have.
template <class Message>
std::size_t most_bytes(const Message& message, int agents) {
  Size size(agents);
  const_cast<Message&>(message).visit(size);
  return size.most();
}
/// Whether the body may have other sizes than it has now.
template <class Message>
bool varies(const Message& message, int agents) {
  Size size(agents);
  const_cast<Message&>(message).visit(size);
  return size.most() != size.now();
}
/// Writes the body; returns its size. `out` has room for most_bytes.
template <class Message>
std::size_t encode(const Message& message, int agents, std::byte* out) noexcept {
  Encoder encoder(out, agents);
  const_cast<Message&>(message).visit(encoder);
  return encoder.written();
}
/// Reads a body into a message of the right shape. On refusal the message is not to be used.
template <class Message>
Refusal decode(std::span<const std::byte> body, int agents, Message& message) noexcept {
  Decoder decoder(body, agents);
  message.visit(decoder);
  return decoder.end();
}

}  // namespace garrison::wire
