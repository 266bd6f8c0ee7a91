// SPDX-License-Identifier: Apache-2.0
// States and designs as bytes. Every State and Gains lists its parts once, in `template <class V> void
// visit(V& v)`:
//
//   v("x", x)                       numbers (any bits), whole numbers, flags, strings, vectors, matrices,
//   sets, and
//                                   whatever has such a list itself
//   v.range("filled", k, 0, most)   a whole number that is used as an index or a counter
//   v.choice("verdict", e, count)   an enumeration of `count` values, numbered from 0
//
// Little-endian, in the order of the list, sizes first where they may differ.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "garrison/core/envelope.hpp"
#include "garrison/core/fields.hpp"
#include "garrison/wire/bytes.hpp"

namespace garrison::wire {

/// Bytes of known number, e.g. of a snapshot; how many would not have fitted is counted.
/// Threads: one at a time.
class FixedSink {
 public:
  explicit FixedSink(std::span<std::byte> room) : room_(room) {}
  std::byte* more(std::size_t bytes) {
    const std::size_t at = used_;
    used_ += bytes;
    return used_ <= room_.size() ? room_.data() + at : nullptr;
  }
  /// What was asked for; more than the room if it did not fit.
  std::size_t used() const { return used_; }

 private:
  std::span<std::byte> room_;
  std::size_t used_ = 0;
};
/// Bytes that grow, e.g. of a design file.
/// Threads: one at a time.
class GrowingSink {
 public:
  std::byte* more(std::size_t bytes) {
    bytes_.resize(bytes_.size() + bytes);
    return bytes_.data() + bytes_.size() - bytes;
  }
  std::vector<std::byte> release() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

namespace detail {
template <class T>
struct IsVector : std::false_type {};
template <class T, class Memory>
struct IsVector<std::vector<T, Memory>> : std::true_type {};
template <class T>
concept Sequence = IsVector<T>::value;
template <class T>
concept Dense = std::is_base_of_v<Eigen::MatrixBase<T>, T>;
template <class T>
concept Numbers = std::is_same_v<T, std::span<double>>;
}  // namespace detail

/// Threads: one at a time.
template <class Sink>
class Writer {
 public:
  explicit Writer(Sink& sink) : sink_(sink) {}

  template <class T>
  void operator()(std::string_view, T&& x) {
    put(x);
  }
  template <class T>
  void range(std::string_view, T& x, std::int64_t, std::int64_t) {
    put(x);
  }
  template <class E>
  void choice(std::string_view, E& e, int) {
    put_raw(static_cast<std::uint8_t>(e));
  }

 private:
  template <class Unsigned>
  void put_raw(Unsigned value) {
    if (std::byte* at = sink_.more(sizeof(Unsigned))) store(at, value);
  }
  void put_size(std::size_t size) { put_raw(static_cast<std::uint32_t>(size)); }

  void put(double x) { put_raw(std::bit_cast<std::uint64_t>(x)); }
  void put(bool x) { put_raw<std::uint8_t>(x ? 1 : 0); }
  void put(std::byte x) { put_raw(std::to_integer<std::uint8_t>(x)); }
  template <class T>
    requires(std::is_integral_v<T> && !std::is_same_v<T, bool>)
  void put(T x) {
    put_raw(static_cast<std::make_unsigned_t<T>>(x));
  }
  void put(const std::string& x) {
    put_size(x.size());
    if (std::byte* at = sink_.more(x.size())) std::memcpy(at, x.data(), x.size());
  }
  template <detail::Sequence T>
  void put(T& x) {
    put_size(x.size());
    for (auto& entry : x) put(entry);
  }
  template <detail::Dense T>
  void put(T& x) {
    put_size(static_cast<std::size_t>(x.rows()));
    put_size(static_cast<std::size_t>(x.cols()));
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      for (Eigen::Index r = 0; r < x.rows(); ++r) put(x(r, c));
  }
  template <class T, std::size_t N>
  void put(T (&x)[N]) {
    for (T& entry : x) put(entry);
  }
  template <class T, std::size_t N>
  void put(std::array<T, N>& x) {
    for (T& entry : x) put(entry);
  }
  template <detail::Numbers T>
  void put(T& x) {
    for (const double v : x) put(v);
  }
  void put(AgentSet& x) {
    put_size(x.words());
    for (int k = 0; k < 8 * static_cast<int>(x.words()); ++k) put_raw(x.byte(k));
  }
  void put(LabelSet& x) {
    put_size(static_cast<std::size_t>(x.capacity()));
    put_raw(static_cast<std::uint8_t>(x.complement() ? 1 : 0));
    put_size(static_cast<std::size_t>(x.count()));
    for (const int id : x.listed()) put(id);
    for (int k = x.count(); k < x.capacity(); ++k) put(0);  // a state has one size, whatever its sets hold
  }
  template <class T>
    requires(!detail::Dense<T> && requires(T& x, Writer& v) { x.visit(v); })
  void put(T& x) {
    x.visit(*this);
  }

  Sink& sink_;
};

/// Reads what a Writer wrote. `resize` = false: sizes must be those that the object has (a state after
/// `init`), nothing is allocated. After the first refusal nothing more is read.
/// Threads: one at a time.
class Reader {
 public:
  Reader(std::span<const std::byte> bytes, int agents, bool resize)
      : at_(bytes.data()), end_(bytes.data() + bytes.size()), agents_(agents), resize_(resize) {}

  Refusal refusal() const { return refusal_; }
  /// Once everything is visited: whether all bytes were understood.
  Refusal end() const {
    if (refusal_ != Refusal::none) return refusal_;
    return at_ == end_ ? Refusal::none : Refusal::size;
  }
  std::span<const std::byte> rest() const { return {at_, end_}; }

  template <class T>
  void operator()(std::string_view, T&& x) {
    take(x);
  }
  template <class T>
  void range(std::string_view, T& x, std::int64_t least, std::int64_t most) {
    take(x);
    if (static_cast<std::int64_t>(x) < least || static_cast<std::int64_t>(x) > most) refuse_as(Refusal::flag);
  }
  template <class E>
  void choice(std::string_view, E& e, int count) {
    std::uint8_t value = 0;
    take_raw(value);
    if (value >= count) return refuse_as(Refusal::flag);
    e = static_cast<E>(value);
  }

 private:
  bool has(std::size_t bytes) {
    if (refusal_ != Refusal::none) return false;
    if (static_cast<std::size_t>(end_ - at_) >= bytes) return true;
    refuse_as(Refusal::size);
    return false;
  }
  void refuse_as(Refusal why) {
    if (refusal_ == Refusal::none) refusal_ = why;
  }
  template <class Unsigned>
  void take_raw(Unsigned& value) {
    if (!has(sizeof(Unsigned))) return;
    value = load<Unsigned>(at_);
    at_ += sizeof(Unsigned);
  }
  /// A size that the remaining bytes can fill with entries of so many bytes.
  std::size_t take_size(std::size_t entry) {
    std::uint32_t size = 0;
    take_raw(size);
    if (refusal_ != Refusal::none) return 0;
    if (size > static_cast<std::size_t>(end_ - at_) / entry) {
      refuse_as(Refusal::size);
      return 0;
    }
    return size;
  }

  void take(double& x) {
    std::uint64_t bits = 0;
    take_raw(bits);
    if (refusal_ == Refusal::none) x = std::bit_cast<double>(bits);
  }
  void take(std::byte& x) {
    if (has(1)) x = *at_++;
  }
  void take(bool& x) {
    std::uint8_t byte = 0;
    take_raw(byte);
    if (byte > 1) return refuse_as(Refusal::flag);
    x = byte == 1;
  }
  template <class T>
    requires(std::is_integral_v<T> && !std::is_same_v<T, bool>)
  void take(T& x) {
    std::make_unsigned_t<T> raw = 0;
    take_raw(raw);
    if (refusal_ == Refusal::none) x = static_cast<T>(raw);
  }
  void take(std::string& x) {
    const std::size_t size = take_size(1);
    if (refusal_ != Refusal::none) return;
    x.assign(reinterpret_cast<const char*>(at_), size);
    at_ += size;
  }
  template <detail::Sequence T>
  void take(T& x) {
    const std::size_t size = take_size(1);
    if (refusal_ != Refusal::none) return;
    if (size != x.size()) {
      if (!resize_) return refuse_as(Refusal::size);
      x.clear();
      // One by one: a claim of many large entries must not allocate more than the bytes that are there.
      for (std::size_t k = 0; k < size && refusal_ == Refusal::none; ++k) take(x.emplace_back());
      return;
    }
    for (auto& entry : x) take(entry);
  }
  template <detail::Dense T>
  void take(T& x) {
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    take_raw(rows);
    take_raw(columns);
    if (refusal_ != Refusal::none) return;
    if (static_cast<std::uint64_t>(rows) * columns > static_cast<std::size_t>(end_ - at_) / 8)
      return refuse_as(Refusal::size);
    if (rows != x.rows() || columns != x.cols()) {
      if constexpr (T::RowsAtCompileTime == Eigen::Dynamic || T::ColsAtCompileTime == Eigen::Dynamic) {
        constexpr Eigen::Index kRows = T::RowsAtCompileTime;
        constexpr Eigen::Index kColumns = T::ColsAtCompileTime;
        const bool fits =
            (kRows == Eigen::Dynamic || kRows == rows) && (kColumns == Eigen::Dynamic || kColumns == columns);
        if (!resize_ || !fits) return refuse_as(Refusal::size);
        x.resize(rows, columns);
      } else {
        return refuse_as(Refusal::size);
      }
    }
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      for (Eigen::Index r = 0; r < x.rows(); ++r) take(x(r, c));
  }
  template <class T, std::size_t N>
  void take(T (&x)[N]) {
    for (T& entry : x) take(entry);
  }
  template <class T, std::size_t N>
  void take(std::array<T, N>& x) {
    for (T& entry : x) take(entry);
  }
  template <detail::Numbers T>
  void take(T& x) {
    for (double& v : x) take(v);
  }
  void take(AgentSet& x) {
    const std::size_t words = take_size(8);
    if (refusal_ != Refusal::none) return;
    if (words != x.words()) {
      if (!resize_ || words > (static_cast<std::size_t>(agents_) + 63) / 64) return refuse_as(Refusal::size);
      x.resize(static_cast<int>(64 * words));
    }
    if (words == 0) return;
    x.clear();
    for (int k = 0; k < 8 * static_cast<int>(words); ++k) {
      const auto bits = std::to_integer<std::uint8_t>(*at_++);
      x.set_byte(k, bits);
      for (int b = 0; b < 8; ++b)
        if ((bits >> b & 1) != 0 && 8 * k + b >= agents_) refuse_as(Refusal::set);
    }
  }
  void take(LabelSet& x) {
    std::uint32_t capacity = 0;
    std::uint8_t complement = 0;
    take_raw(capacity);
    take_raw(complement);
    std::uint32_t listed = 0;
    take_raw(listed);
    if (refusal_ != Refusal::none) return;
    if (static_cast<int>(capacity) != x.capacity() || listed > capacity) return refuse_as(Refusal::size);
    if (complement > 1) return refuse_as(Refusal::flag);
    x.start(static_cast<int>(listed), complement == 1);
    int last = -1;
    for (std::uint32_t k = 0; k < capacity; ++k) {
      int id = 0;
      take(id);
      if (k >= listed) continue;
      if (id <= last || id >= agents_) {
        x.clear();
        return refuse_as(Refusal::set);
      }
      x.place(static_cast<int>(k), last = id);
    }
  }
  template <class T>
    requires(!detail::Dense<T> && requires(T& x, Reader& v) { x.visit(v); })
  void take(T& x) {
    x.visit(*this);
  }

  const std::byte* at_;
  const std::byte* end_;
  int agents_;
  bool resize_;
  Refusal refusal_ = Refusal::none;
};

/// All bytes of an object that lists its parts.
template <class T>
std::vector<std::byte> to_bytes(const T& x) {
  GrowingSink sink;
  Writer<GrowingSink> writer(sink);
  writer("", const_cast<T&>(x));  // only read
  return sink.release();
}
/// Reads an object that lists its parts; its vectors take the sizes that were written.
template <class T>
Refusal from_bytes(std::span<const std::byte> bytes, int agents, T& x) {
  Reader reader(bytes, agents, true);
  reader("", x);
  return reader.end();
}

}  // namespace garrison::wire
