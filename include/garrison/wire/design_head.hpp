// SPDX-License-Identifier: Apache-2.0
// How a design file begins, for those who read one without exceptions (engine/design_file.hpp has its
// layout).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "garrison/version.hpp"
#include "garrison/wire/archive.hpp"
#include "garrison/wire/blake2b.hpp"

namespace garrison::wire {

inline constexpr char kDesignMagic[8] = {'G', 'D', 'E', 'S', 'I', 'G', 'N', '1'};

/// A parameter's value, one member of which is meant.
struct DesignParam {
  std::string name;
  std::uint8_t kind = 0;
  bool flag = false;
  std::int64_t whole = 0;
  double number = 0.0;
  std::string words;
  std::vector<double> list;

  template <class V>
  void visit(V& v) {
    v("name", name);
    v.range("kind", kind, 0, 4);
    switch (kind) {
      case 0:
        return v("value", flag);
      case 1:
        return v("value", whole);
      case 2:
        return v("value", number);
      case 3:
        return v("value", words);
      default:
        return v("value", list);
    }
  }
};

/// What both kinds of files begin with.
struct DesignHead {
  std::uint32_t version = 2;
  bool part = false;
  std::int32_t agent = -1;
  std::string garrison = GARRISON_VERSION;
  std::string filter;
  std::vector<DesignParam> params;
  std::int32_t agents = 0;
  std::int32_t states = 0;

  template <class V>
  void visit(V& v) {
    v.range("version", version, 2, 2);
    v("part", part);
    v.range("agent", agent, -1, INT32_MAX);
    v("garrison", garrison);
    v("filter", filter);
    v("params", params);
    v.range("agents", agents, 1, INT32_MAX);
    v.range("states", states, 1, INT32_MAX);
  }
};

/// Leaves `reader` behind the head of a file. Refused: size (it does not begin like one), damaged (its hash
/// does not match), foreign (another version).
inline Refusal open_design(std::span<const std::byte> file, DesignHead& head, Reader& reader) {
  if (file.size() < sizeof kDesignMagic + sizeof(Digest) ||
      !std::equal(kDesignMagic, kDesignMagic + 7, reinterpret_cast<const char*>(file.data())))
    return Refusal::size;
  const auto content = file.first(file.size() - sizeof(Digest));
  const Digest digest = blake2b(content);
  if (!std::equal(digest.begin(), digest.end(), file.end() - sizeof(Digest))) return Refusal::damaged;
  reader = Reader(content.subspan(sizeof kDesignMagic), INT32_MAX, true);
  reader("head", head);
  return reader.refusal() == Refusal::none ? Refusal::none : Refusal::foreign;
}

}  // namespace garrison::wire
