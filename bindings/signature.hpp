// SPDX-License-Identifier: Apache-2.0
// What a bound function takes, read from the first line of its documentation: the one place where pybind11
// names the types of all arguments.
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct ArgumentType {
  enum class Kind {
    anything,
    many,
    number,
    whole,
    flag,
    text,
    array,
    matrix,
    vector,
    wholes,
    list,
    tuple,
    map,
    instance
  };
  Kind kind = Kind::anything;
  bool optional = false;              ///< None is fine
  std::vector<ArgumentType> of = {};  ///< what a list or tuple holds
  pybind11::handle instance = {};     ///< the class of an object of ours

  /// "a whole number", as a message says it.
  std::string expected() const;
};

struct Argument {
  std::string name;
  ArgumentType type;
  bool required = true;
  bool keyword_only = false;
};

/// Classes by the name that documentation gives them: garrison._core.Model.
using Classes = std::map<std::string, pybind11::handle, std::less<>>;

/// The arguments of "name(a: type, b: type = default) -> type"; none for other texts (overloads, wrappers).
std::optional<std::vector<Argument>> parse_signature(std::string_view line, const Classes& classes);
