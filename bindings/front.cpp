// SPDX-License-Identifier: Apache-2.0
#include "front.hpp"

#include <algorithm>

#include "convert.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/params.hpp"
#include "read.hpp"

namespace py = pybind11;
using garrison::refuse;
using Kind = ArgumentType::Kind;

namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "none" : all;
}

/// Whether the function gives its object the content: a constructor, or what unpickling calls.
bool fills(const Front& front) {
  return front.name.find('.') == std::string::npos || front.name.ends_with(".__setstate__");
}

/// Refuses what belongs in the place of another argument.
void require_place(const Front& front, std::size_t k, py::handle value,
                   const std::vector<std::string>& known) {
  const auto takes = [&](const Argument& argument) {
    return argument.type.kind == Kind::instance && py::isinstance(value, argument.type.instance);
  };
  const Argument& here = front.takes[k];
  if (here.type.kind != Kind::instance || takes(here)) return;
  if (std::any_of(front.takes.begin() + (front.method ? 1 : 0), front.takes.end(), takes))
    refuse(front.name + "." + here.name, convert::shown(value), here.type.expected(),
           "the order is " + joined(known));
}

}  // namespace

std::vector<py::object> sorted_values(const Front& front, const Call& call) {
  std::vector<py::handle> values(front.takes.size());
  std::vector<std::string> known;
  std::size_t places = 0;
  for (std::size_t k = front.method ? 1 : 0; k < front.takes.size(); ++k)
    known.push_back(front.takes[k].name);
  for (const auto& argument : front.takes) places += argument.keyword_only ? 0 : 1;
  if (call.positional.size() > places) {
    const std::size_t self = front.method ? 1 : 0;
    refuse(front.name, std::to_string(call.positional.size() - self) + " arguments without a name",
           std::to_string(places - self) + " at most", "its arguments: " + joined(known));
  }
  std::copy(call.positional.begin(), call.positional.end(), values.begin());
  for (const auto& [keyword, value] : call.named) {
    const std::string name = convert::words(front.name, keyword);
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      const std::string near = garrison::nearest_name(name, known);
      refuse(front.name, "the unknown argument \"" + name + "\"", "one of: " + joined(known),
             near.empty() ? "" : "did you mean \"" + near + "\"?");
    }
    auto& slot = values[static_cast<std::size_t>(found - known.begin()) + (front.method ? 1 : 0)];
    if (slot) refuse(front.name + "." + name, "two values", "one");
    slot = value;
  }
  std::vector<py::object> all(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Argument& argument = front.takes[k];
    const bool self = front.method && k == 0;
    if (!self && values[k]) require_place(front, k, values[k], known);
    const std::string which = front.name + "." + argument.name;
    if (!values[k] && argument.required) refuse(which, "no value", argument.type.expected());
    if (!values[k]) continue;
    all[k] = self && fills(front)  // the object is still empty
                 ? py::reinterpret_borrow<py::object>(values[k])
                 : read(argument.type, which, values[k]);
  }
  return all;
}

PyObject* call_original(const Front& front, PyObject* self, const std::vector<py::object>& values,
                        bool fast) {
  std::vector<PyObject*> given;
  std::vector<py::object> names;
  std::size_t positional = 0;
  bool gap = false;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!values[k]) {
      gap = true;
      continue;
    }
    if (!gap && !front.takes[k].keyword_only)
      ++positional;
    else
      names.push_back(py::str(front.takes[k].name));
    given.push_back(values[k].ptr());
  }
  if (fast) {
    py::tuple keywords(names.size());
    for (std::size_t k = 0; k < names.size(); ++k) keywords[k] = names[k];
    const auto function =
        reinterpret_cast<_PyCFunctionFastWithKeywords>(reinterpret_cast<void (*)()>(front.original));
    return function(self, given.data(), static_cast<Py_ssize_t>(positional),
                    names.empty() ? nullptr : keywords.ptr());
  }
  py::tuple arguments(positional);
  for (std::size_t k = 0; k < positional; ++k) arguments[k] = py::reinterpret_borrow<py::object>(given[k]);
  py::dict keywords;
  for (std::size_t k = 0; k < names.size(); ++k)
    keywords[names[k]] = py::reinterpret_borrow<py::object>(given[positional + k]);
  const auto function =
      reinterpret_cast<PyCFunctionWithKeywords>(reinterpret_cast<void (*)()>(front.original));
  return function(self, arguments.ptr(), names.empty() ? nullptr : keywords.ptr());
}

std::string blame(const Front& front, const std::vector<py::object>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    const ArgumentType& type = front.takes[k].type;
    if (!values[k] || values[k].is_none()) continue;
    const std::string which = front.name + "." + front.takes[k].name;
    if (type.kind == Kind::whole) {
      if (values[k] < py::int_(0))
        return which + ": got " + convert::shown(values[k]) + ", expected a whole number >= 0";
      if (values[k] > py::int_(2147483647))
        return which + ": got " + convert::shown(values[k]) +
               ", expected a whole number of at most 2147483647";
    }
    if (type.kind == Kind::list && type.of.front().kind == Kind::whole)
      for (const auto& one : values[k])
        if (one > py::int_(2147483647) || one < py::int_(-2147483647))
          return which + ": got " + convert::shown(one) + ", expected whole numbers of at most 2147483647";
  }
  std::string got;
  std::string expected;
  for (std::size_t k = front.method ? 1 : 0; k < values.size(); ++k) {
    got += (got.empty() ? "" : ", ") + front.takes[k].name + " = " +
           (values[k] ? convert::shown(values[k]) : "default");
    expected += (expected.empty() ? "" : ", ") + front.takes[k].name + " = " + front.takes[k].type.expected();
  }
  return front.name + ": got " + (got.empty() ? "no object" : got) + ", expected " +
         (expected.empty() ? "one" : expected);
}
