// SPDX-License-Identifier: Apache-2.0
#include "read.hpp"

#include <algorithm>
#include <set>

#include "convert.hpp"
#include "garrison/core/error.hpp"

namespace py = pybind11;
using garrison::refuse;
using Kind = ArgumentType::Kind;

namespace {

/// Arguments in which nan says that something is missing, or inf that something is impossible.
bool may_be_missing(const std::string& which) {
  static const std::set<std::string, std::less<>> names{
      "cost", "delta", "disturbances", "measured", "measurements", "raw", "residuals", "truth", "y", "z"};
  const auto begin = which.find_last_of('.') + 1;
  return names.count(which.substr(begin, which.find('[', begin) - begin)) != 0;
}

/// Refuses nan and what is so large that its square overflows.
convert::Array usable(const std::string& which, convert::Array given) {
  if (may_be_missing(which)) return given;
  const double* end = given.data() + given.size();
  const double* wrong =
      std::find_if(given.data(), end, [](double x) { return !(std::abs(x) <= garrison::kHuge); });
  if (wrong != end)
    refuse(which, garrison::text(*wrong),
           "finite numbers of size at most " + garrison::text(garrison::kHuge));
  return given;
}

/// Whole numbers in lists are agents, states and the like.
py::object read_entry(const ArgumentType& type, const std::string& which, py::handle given) {
  return type.kind == Kind::whole ? py::int_(convert::small(which, given)) : read(type, which, given);
}

py::object read_list(const ArgumentType& type, const std::string& which, py::handle given) {
  const ArgumentType& inner = type.of.front();
  const bool text = PyUnicode_Check(given.ptr()) || PyBytes_Check(given.ptr());
  const bool simple = inner.kind == Kind::number || inner.kind == Kind::whole || inner.kind == Kind::text ||
                      inner.kind == Kind::instance;
  const bool alone = inner.kind == Kind::text       ? text
                     : inner.kind == Kind::instance ? py::isinstance(given, inner.instance)
                                                    : simple && !text && convert::scalar(given);
  py::list all;
  if (alone) {  // one agent, one name: a list of one
    all.append(read_entry(inner, which, given));
    return all;
  }
  if (text || PyDict_Check(given.ptr()) || convert::scalar(given))
    refuse(which, convert::shown(given), type.expected());
  if (inner.kind == Kind::number) {  // an array's mask and missing values are not lost
    const auto numbers = convert::array(which,
                                        py::isinstance<py::array>(given)
                                            ? py::reinterpret_borrow<py::object>(given)
                                            : py::object(convert::listed(which, given, "a list of numbers")),
                                        "a list of numbers");
    if (numbers.ndim() != 1)
      refuse(which, "an array of shape " + py::str(numbers.attr("shape")).cast<std::string>(),
             "a list of numbers");
    return numbers.attr("tolist")();
  }
  std::size_t k = 0;
  for (const auto& one : convert::listed(which, given, type.expected()))
    all.append(read_entry(inner, which + "[" + std::to_string(k++) + "]", one));
  return all;
}

py::object read_tuple(const ArgumentType& type, const std::string& which, py::handle given) {
  const bool can =
      py::hasattr(given, "__iter__") && !PyUnicode_Check(given.ptr()) && !PyDict_Check(given.ptr());
  // A 0-d array has __iter__ and no values.
  const bool scalar = py::hasattr(given, "ndim") && given.attr("ndim").cast<int>() == 0;
  const py::list parts = can && !scalar ? convert::listed(which, given, type.expected()) : py::list();
  if (parts.size() != type.of.size())
    refuse(which, can ? garrison::amount(parts.size(), "value") : convert::shown(given), type.expected());
  py::tuple all(type.of.size());
  for (std::size_t k = 0; k < parts.size(); ++k)
    all[k] = read(type.of[k], which + "[" + std::to_string(k) + "]", parts[k]);
  return all;
}

py::object read_wholes(const std::string& which, py::handle given) {
  const auto numbers = convert::array(which, given, "a list of whole numbers");
  const double* end = numbers.data() + numbers.size();
  const double* wrong = std::find_if(
      numbers.data(), end, [](double x) { return x != std::floor(x) || std::abs(x) > 2147483647.0; });
  if (wrong != end) refuse(which, garrison::text(*wrong), "a list of whole numbers");
  return numbers.attr("astype")("int32");
}

/// Whether it is one of ours of which no constructor has run: pybind11 would make room for the content and
/// leave it as it is.
bool empty(py::handle object) {
  auto* const base = reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base);
  if (PyObject_TypeCheck(object.ptr(), base) == 0) return false;
  return reinterpret_cast<py::detail::instance*>(object.ptr())->get_value_and_holder().value_ptr() == nullptr;
}

}  // namespace

py::object read(const ArgumentType& type, const std::string& which, py::handle given) {
  if (empty(given))
    refuse(which, "an object without its content, as __new__ alone leaves it", type.expected(),
           "make it by calling the class, or the function that returns it");
  if (given.is_none()) {
    if (type.optional) return py::none();
    refuse(which, "None", type.expected());
  }
  switch (type.kind) {
    case Kind::number:
      return py::float_(convert::number(which, given));
    case Kind::whole:
      return convert::whole(which, given);
    case Kind::flag:
      return py::bool_(convert::flag(which, given));
    case Kind::text:
      return py::str(convert::words(which, given));
    case Kind::array:
      return convert::array(which, given);
    case Kind::matrix:
      return usable(which, convert::matrix(which, given));
    case Kind::vector:
      return usable(which, convert::vector(which, given));
    case Kind::wholes:
      return read_wholes(which, given);
    case Kind::list:
      return read_list(type, which, given);
    case Kind::tuple:
      return read_tuple(type, which, given);
    case Kind::many:
      if (convert::scalar(given) || PyUnicode_Check(given.ptr()) || PyBytes_Check(given.ptr()) ||
          PyDict_Check(given.ptr()))
        refuse(which, convert::shown(given), type.expected());
      return convert::listed(which, given, type.expected());
    case Kind::map:
      if (!PyMapping_Check(given.ptr()) || !py::hasattr(given, "keys"))
        refuse(which, convert::shown(given), type.expected());
      return py::dict(py::reinterpret_borrow<py::object>(given));
    case Kind::instance:
      if (!py::isinstance(given, type.instance)) refuse(which, convert::shown(given), type.expected());
      return py::reinterpret_borrow<py::object>(given);
    case Kind::anything:
      break;
  }
  return py::reinterpret_borrow<py::object>(given);
}
