// SPDX-License-Identifier: Apache-2.0
// What a message is made of. Every Message lists its fields once, in `template <class V> void visit(V& v)`:
//
//   v.numbers("estimate", x)        doubles, finite and below kHuge
//   v.optional("bound", bound)      a double that may be absent (NaN)
//   v.sparse("heard", y)            doubles, each of which may be absent (NaN)
//   v.flag("intact", intact)        bool
//   v.count("rest", rest, most)     a whole number in 0..most <= 65535
//   v.set("proved", proved)         AgentSet
//   v.labels("attacked", attacked)  LabelSet
//
// From that one list follow the wire form and its exact size (wire/), what is refused as not finite, lies
// about any field (attacks/) and what a person sees of a message. Names are literals: they are kept by
// address.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "garrison/core/agent_set.hpp"
#include "garrison/core/label_set.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

enum class FieldKind : std::uint8_t { numbers, optional, flag, count, set, labels, sparse };
inline constexpr int kFieldKinds = 7;

/// One field of a message in memory; what `data` points to follows from `kind`.
struct FieldRef {
  std::string_view name;
  FieldKind kind;
  void* data;
  int size;  ///< of numbers and sparse: how many; of a count: the largest; else 1
};

/// What visitors of messages make of vectors that know their size.
template <class Derived>
struct NumbersOf {
  template <class Numbers>
    requires requires(Numbers& v) { v.data(); }
  void numbers(std::string_view name, Numbers& values) {
    static_cast<Derived*>(this)->numbers(
        name, std::span<double>(values.data(), static_cast<std::size_t>(values.size())));
  }
  template <class Numbers>
    requires requires(Numbers& v) { v.data(); }
  void sparse(std::string_view name, Numbers& values) {
    static_cast<Derived*>(this)->sparse(
        name, std::span<double>(values.data(), static_cast<std::size_t>(values.size())));
  }
};

/// All fields of one message, in the order in which they are listed; of several, those that travel as one.
/// Threads: one at a time.
class FieldList : public NumbersOf<FieldList> {
 public:
  /// Fields of a family's message; and with those of a certificate behind them.
  static constexpr std::size_t kMost = 12;
  static constexpr std::size_t kMostTogether = kMost + 4;

  template <class... Messages>
  explicit FieldList(Messages&... messages) {
    (messages.visit(*this), ...);
  }
  std::span<const FieldRef> all() const { return {fields_.data(), size_}; }
  const FieldRef* find(std::string_view name) const {
    for (const FieldRef& field : all())
      if (field.name == name) return &field;
    return nullptr;
  }
  /// Calls action(k, value) for every number, counted over all fields of kind `numbers`.
  template <class Action>
  void each_number(const Action& action) const {
    std::size_t k = 0;
    for (const FieldRef& field : all())
      if (field.kind == FieldKind::numbers)
        for (int i = 0; i < field.size; ++i) action(k++, static_cast<double*>(field.data)[i]);
  }

  using NumbersOf<FieldList>::numbers;
  using NumbersOf<FieldList>::sparse;
  void numbers(std::string_view name, std::span<double> values) {
    add({name, FieldKind::numbers, values.data(), static_cast<int>(values.size())});
  }
  void sparse(std::string_view name, std::span<double> values) {
    add({name, FieldKind::sparse, values.data(), static_cast<int>(values.size())});
  }
  void optional(std::string_view name, double& value) { add({name, FieldKind::optional, &value, 1}); }
  void flag(std::string_view name, bool& value) { add({name, FieldKind::flag, &value, 1}); }
  void count(std::string_view name, int& value, int most) { add({name, FieldKind::count, &value, most}); }
  void set(std::string_view name, AgentSet& value) { add({name, FieldKind::set, &value, 1}); }
  void labels(std::string_view name, LabelSet& value) { add({name, FieldKind::labels, &value, 1}); }

 private:
  void add(const FieldRef& field) { fields_[size_++] = field; }
  std::array<FieldRef, kMostTogether> fields_;
  std::size_t size_ = 0;
};

namespace detail {
struct Bounded : NumbersOf<Bounded> {
  bool all = true;
  using NumbersOf<Bounded>::numbers;
  using NumbersOf<Bounded>::sparse;
  void numbers(std::string_view, std::span<double> values) {
    for (const double v : values) all &= std::abs(v) < kHuge;
  }
  void sparse(std::string_view, std::span<double> values) {
    for (const double v : values) all &= std::isnan(v) || std::abs(v) < kHuge;
  }
  void optional(std::string_view, double v) { all &= std::isnan(v) || std::abs(v) < kHuge; }
  void flag(std::string_view, bool) {}
  void count(std::string_view, int value, int most) { all &= value >= 0 && value <= most; }
  void set(std::string_view, AgentSet&) {}
  void labels(std::string_view, LabelSet&) {}
};
}  // namespace detail

/// Whether every number of a message is finite and below kHuge: others are never delivered.
template <class Message>
bool bounded(const Message& message) {
  detail::Bounded look;
  const_cast<Message&>(message).visit(look);  // only read
  return look.all;
}

}  // namespace garrison
