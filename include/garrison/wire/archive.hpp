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
template <class T>
concept Whole = std::is_integral_v<T> && !std::is_same_v<T, bool>;
}  // namespace detail

/// What goes through a list of parts: a writer or a reader. The list is compiled once for both; what is done
/// with each kind of part is not compiled again for every State.
/// Threads: one at a time.
class Archive {
 public:
  template <class T>
  void operator()(std::string_view, T&& x) {
    pass(x);
  }
  template <detail::Whole T>
  void range(std::string_view, T& x, std::int64_t least, std::int64_t most) {
    pass_whole(x, least, most);
  }
  template <class E>
  void choice(std::string_view, E& e, int count) {
    auto value = static_cast<std::int64_t>(e);
    if (whole(value, 1, false, 0, count - 1)) e = static_cast<E>(value);
  }

 protected:
  ~Archive() = default;

  virtual void number(double& x) = 0;
  virtual void numbers(double* x, std::size_t count) = 0;
  /// A whole number of so many bytes; whether it may be used: one that was read, within its range.
  virtual bool whole(std::int64_t& x, int bytes, bool is_signed, std::int64_t least, std::int64_t most) = 0;
  virtual void flag(bool& x) = 0;
  virtual void bytes(std::byte* x, std::size_t count) = 0;
  /// A number of entries of so many bytes at least; whether as many follow.
  virtual bool size(std::size_t& x, std::size_t entry) = 0;
  /// Rows and columns of a matrix; whether its entries follow.
  virtual bool shape(std::size_t& rows, std::size_t& columns) = 0;
  /// What has another size than was written may take it.
  virtual bool may_resize() const = 0;
  virtual bool refused() const = 0;
  virtual void refuse_as(Refusal why) = 0;
  virtual void set(AgentSet& x) = 0;
  virtual void labels(LabelSet& x) = 0;

 private:
  template <detail::Whole T>
  void pass_whole(T& x, std::int64_t least, std::int64_t most) {
    auto value = static_cast<std::int64_t>(x);
    if (whole(value, sizeof(T), std::is_signed_v<T>, least, most)) x = static_cast<T>(value);
  }

  void pass(double& x) { number(x); }
  void pass(bool& x) { flag(x); }
  void pass(std::byte& x) { bytes(&x, 1); }
  void pass(AgentSet& x) { set(x); }
  void pass(LabelSet& x) { labels(x); }
  template <detail::Whole T>
  void pass(T& x) {
    pass_whole(x, INT64_MIN, INT64_MAX);
  }
  void pass(std::string& x) {
    std::size_t count = x.size();
    if (!size(count, 1)) return;
    x.resize(count);
    bytes(reinterpret_cast<std::byte*>(x.data()), count);
  }
  template <detail::Sequence T>
  void pass(T& x) {
    std::size_t count = x.size();
    if (!size(count, 1)) return;
    if (count == x.size()) {
      each(x.data(), count);
    } else if (!may_resize()) {
      refuse_as(Refusal::size);
    } else {
      x.clear();
      // One by one: a claim of many large entries must not allocate more than the bytes that are there.
      for (std::size_t k = 0; k < count && !refused(); ++k) pass(x.emplace_back());
    }
  }
  template <detail::Dense T>
  void pass(T& x) {
    auto rows = static_cast<std::size_t>(x.rows());
    auto columns = static_cast<std::size_t>(x.cols());
    if (!shape(rows, columns)) return;
    if (!takes_shape(x, static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns)))
      return refuse_as(Refusal::size);
    if constexpr (std::is_base_of_v<Eigen::PlainObjectBase<T>, T> && !T::IsRowMajor &&
                  std::is_same_v<typename T::Scalar, double>)
      numbers(x.data(), rows * columns);
    else if (x.rows() > 0)  // else there may be billions of columns
      for (Eigen::Index c = 0; c < x.cols(); ++c)
        for (Eigen::Index r = 0; r < x.rows(); ++r) pass(x(r, c));
  }
  template <detail::Dense T>
  bool takes_shape(T& x, Eigen::Index rows, Eigen::Index columns) {
    if (rows == x.rows() && columns == x.cols()) return true;
    constexpr Eigen::Index kRows = T::RowsAtCompileTime;
    constexpr Eigen::Index kColumns = T::ColsAtCompileTime;
    if constexpr (kRows == Eigen::Dynamic || kColumns == Eigen::Dynamic) {
      const bool fits =
          (kRows == Eigen::Dynamic || kRows == rows) && (kColumns == Eigen::Dynamic || kColumns == columns);
      if (!may_resize() || !fits) return false;
      x.resize(rows, columns);
      return true;
    }
    return false;
  }
  template <class T, std::size_t N>
  void pass(T (&x)[N]) {
    each(x, N);
  }
  template <class T, std::size_t N>
  void pass(std::array<T, N>& x) {
    each(x.data(), N);
  }
  template <detail::Numbers T>
  void pass(T& x) {
    numbers(x.data(), x.size());
  }
  template <class T>
    requires(!detail::Dense<T> && requires(T& x, Archive& v) { x.visit(v); })
  void pass(T& x) {
    x.visit(*this);
  }

  template <class T>
  void each(T* x, std::size_t count) {
    if constexpr (std::is_same_v<T, double>)
      numbers(x, count);
    else if constexpr (std::is_same_v<T, std::byte>)
      bytes(x, count);
    else
      for (std::size_t k = 0; k < count; ++k) pass(x[k]);
  }
};

/// Writes into bytes of known number, e.g. a snapshot, or into bytes that grow, e.g. of a design file.
/// Threads: one at a time.
class Writer final : public Archive {
 public:
  /// What does not fit is counted.
  explicit Writer(std::span<std::byte> room) : room_(room) {}
  /// Behind what is there.
  explicit Writer(std::vector<std::byte>& grows) : grows_(&grows), used_(grows.size()) {}
  /// What was asked for; more than the room if it did not fit.
  std::size_t used() const { return used_; }

 private:
  std::byte* more(std::size_t bytes) {
    const std::size_t at = used_;
    used_ += bytes;
    if (grows_ != nullptr) {
      grows_->resize(used_);
      return grows_->data() + at;
    }
    return used_ <= room_.size() ? room_.data() + at : nullptr;
  }
  template <class Unsigned>
  void put(Unsigned value) {
    if (std::byte* at = more(sizeof(Unsigned))) store(at, value);
  }
  void put_size(std::size_t size) { put(static_cast<std::uint32_t>(size)); }

  void number(double& x) override { put(std::bit_cast<std::uint64_t>(x)); }
  void numbers(double* x, std::size_t count) override {
    for (std::size_t k = 0; k < count; ++k) number(x[k]);
  }
  bool whole(std::int64_t& x, int bytes, bool, std::int64_t, std::int64_t) override {
    std::byte* at = more(static_cast<std::size_t>(bytes));
    for (int k = 0; at != nullptr && k < bytes; ++k)
      at[k] = static_cast<std::byte>(static_cast<std::uint64_t>(x) >> (8 * k));
    return false;  // stays as it is
  }
  void flag(bool& x) override { put<std::uint8_t>(x ? 1 : 0); }
  void bytes(std::byte* x, std::size_t count) override {
    if (std::byte* at = more(count); at != nullptr && count > 0) std::memcpy(at, x, count);
  }
  bool size(std::size_t& x, std::size_t) override {
    put_size(x);
    return true;
  }
  bool shape(std::size_t& rows, std::size_t& columns) override {
    put_size(rows);
    put_size(columns);
    return true;
  }
  bool may_resize() const override { return false; }
  bool refused() const override { return false; }
  void refuse_as(Refusal) override {}  // what is written is as it is
  void set(AgentSet& x) override {
    put_size(x.words());
    for (int k = 0; k < 8 * static_cast<int>(x.words()); ++k) put(x.byte(k));
  }
  void labels(LabelSet& x) override {
    put_size(static_cast<std::size_t>(x.capacity()));
    put(static_cast<std::uint8_t>(x.complement() ? 1 : 0));
    put_size(static_cast<std::size_t>(x.count()));
    for (const int id : x.listed()) put(static_cast<std::uint32_t>(id));
    // a state has one size, whatever its sets hold
    for (int k = x.count(); k < x.capacity(); ++k) put(std::uint32_t{0});
  }

  std::span<std::byte> room_;
  std::vector<std::byte>* grows_ = nullptr;
  std::size_t used_ = 0;
};

/// Reads what a Writer wrote. `resize` = false: sizes must be those that the object has (a state after
/// `init`), nothing is allocated. After the first refusal nothing more is read.
/// Threads: one at a time.
class Reader final : public Archive {
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

 private:
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  bool has(std::size_t bytes) {
    if (refused()) return false;
    if (left() >= bytes) return true;
    refuse_as(Refusal::size);
    return false;
  }
  template <class Unsigned>
  Unsigned take() {
    if (!has(sizeof(Unsigned))) return 0;
    at_ += sizeof(Unsigned);
    return load<Unsigned>(at_ - sizeof(Unsigned));
  }

  void number(double& x) override {
    const auto bits = take<std::uint64_t>();
    if (!refused()) x = std::bit_cast<double>(bits);
  }
  void numbers(double* x, std::size_t count) override {
    for (std::size_t k = 0; k < count && !refused(); ++k) number(x[k]);
  }
  bool whole(std::int64_t& x, int bytes, bool is_signed, std::int64_t least, std::int64_t most) override {
    if (!has(static_cast<std::size_t>(bytes))) return false;
    std::uint64_t raw = 0;
    for (int k = 0; k < bytes; ++k) raw |= static_cast<std::uint64_t>(*at_++) << (8 * k);
    const int unused = 64 - 8 * bytes;
    const std::int64_t value =
        is_signed ? static_cast<std::int64_t>(raw << unused) >> unused : static_cast<std::int64_t>(raw);
    if (value < least || value > most) refuse_as(Refusal::flag);
    x = value;
    return true;
  }
  void flag(bool& x) override {
    const auto byte = take<std::uint8_t>();
    if (byte > 1) return refuse_as(Refusal::flag);
    if (!refused()) x = byte == 1;
  }
  void bytes(std::byte* x, std::size_t count) override {
    if (!has(count) || count == 0) return;
    std::memcpy(x, at_, count);
    at_ += count;
  }
  /// A size that the remaining bytes can fill with entries of so many bytes.
  bool size(std::size_t& x, std::size_t entry) override {
    x = take<std::uint32_t>();
    if (!refused() && x > left() / entry) refuse_as(Refusal::size);
    return !refused();
  }
  bool shape(std::size_t& rows, std::size_t& columns) override {
    rows = take<std::uint32_t>();
    columns = take<std::uint32_t>();
    if (!refused() && static_cast<std::uint64_t>(rows) * columns > left() / 8) refuse_as(Refusal::size);
    return !refused();
  }
  bool may_resize() const override { return resize_; }
  bool refused() const override { return refusal_ != Refusal::none; }
  void refuse_as(Refusal why) override {
    if (!refused()) refusal_ = why;
  }
  void set(AgentSet& x) override {
    std::size_t words = 0;
    if (!size(words, 8)) return;
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
  void labels(LabelSet& x) override {
    const auto capacity = take<std::uint32_t>();
    const auto complement = take<std::uint8_t>();
    const auto listed = take<std::uint32_t>();
    if (refused()) return;
    if (static_cast<int>(capacity) != x.capacity() || listed > capacity) return refuse_as(Refusal::size);
    if (complement > 1) return refuse_as(Refusal::flag);
    x.start(static_cast<int>(listed), complement == 1);
    int last = -1;
    for (std::uint32_t k = 0; k < capacity; ++k) {
      const auto id = static_cast<int>(take<std::uint32_t>());
      if (k >= listed) continue;
      if (id <= last || id >= agents_) {
        x.clear();
        return refuse_as(Refusal::set);
      }
      x.place(static_cast<int>(k), last = id);
    }
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
  std::vector<std::byte> all;
  Writer writer(all);
  writer("", const_cast<T&>(x));  // only read
  return all;
}
/// Reads an object that lists its parts; its vectors take the sizes that were written.
template <class T>
Refusal from_bytes(std::span<const std::byte> bytes, int agents, T& x) {
  Reader reader(bytes, agents, true);
  reader("", x);
  return reader.end();
}

}  // namespace garrison::wire
