// SPDX-License-Identifier: Apache-2.0
// A message outside of an agent: its body with everything that is needed to say what is in it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "garrison/core/envelope.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/fields.hpp"

namespace garrison::wire {

/// One field as a person or another program sees it.
struct FieldInfo {
  std::string name;
  FieldKind kind = FieldKind::numbers;
  int size = 0;  ///< numbers, sparse: how many; count: the largest; set: agents, 0 = the family keeps none;
                 ///< labels: most listed

  bool operator==(const FieldInfo&) const = default;
  template <class V>
  void visit(V& v) {
    v("name", name);
    v.choice("kind", kind, kFieldKinds);
    v.range("size", size, 0, 1 << 24);
  }
};
/// Adds what a message of `agents` agents is made of.
inline void list_fields(const FieldList& of, int agents, std::vector<FieldInfo>& all) {
  for (const FieldRef& field : of.all()) {
    int size = field.size;
    if (field.kind == FieldKind::set) size = static_cast<AgentSet*>(field.data)->empty() ? 0 : agents;
    if (field.kind == FieldKind::labels) size = static_cast<LabelSet*>(field.data)->capacity();
    all.push_back({std::string(field.name), field.kind, size});
  }
}
/// Ids that are listed, or all but those.
struct Labels {
  std::vector<int> ids;
  bool complement = false;
  bool operator==(const Labels&) const = default;
};
/// numbers and sparse (NaN = absent); optional (NaN = absent); flag; count; set and labels.
using FieldValue = std::variant<std::vector<double>, double, bool, int, Labels>;

/// Value-typed; compares by value.
struct GARRISON_EXPORT Letter {
  std::string family;
  std::uint64_t design = 0;  ///< fingerprint of the design whose agent said it
  Envelope envelope;
  int agents = 0;
  std::vector<FieldInfo> fields;
  std::vector<std::byte> body;

  bool operator==(const Letter&) const = default;
  /// Values in the order of `fields`. @throws InvalidInput when the body is not made of them
  std::vector<FieldValue> values() const;
  /// The same message with another value in one field: a lie. @throws InvalidInput for an unknown name, or a
  /// value of another kind or size
  Letter with(const std::string& name, const FieldValue& value) const;

  std::vector<std::byte> to_bytes() const;
  /// @throws InvalidInput when the bytes are not a message, naming why
  static Letter from_bytes(std::span<const std::byte> bytes);

  template <class V>
  void visit(V& v) {
    v("family", family);
    v("design", design);
    v.range("sender", envelope.sender, 0, INT32_MAX);
    v("sample", envelope.sample);
    v.range("round", envelope.round, 0, INT32_MAX);
    v.range("agents", agents, 1, 1 << 24);
    v("fields", fields);
    v("body", body);
  }
};

}  // namespace garrison::wire
