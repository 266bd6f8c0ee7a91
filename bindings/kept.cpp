// SPDX-License-Identifier: Apache-2.0
#include "kept.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <vector>

namespace py = pybind11;

namespace {

/// Refuses, as Python does, what holds itself.
class Deeper {
 public:
  Deeper() {
    if (Py_EnterRecursiveCall(" in an object that holds itself") != 0) throw py::error_already_set();
  }
  ~Deeper() { Py_LeaveRecursiveCall(); }
  Deeper(const Deeper&) = delete;
  Deeper& operator=(const Deeper&) = delete;
};

/// Arrays as nested lists, NumPy's numbers as Python's.
py::object listed(py::handle value) {
  if (!PyType_Check(value.ptr()) && py::hasattr(value, "tolist")) return value.attr("tolist")();
  return py::reinterpret_borrow<py::object>(value);
}

bool is_sequence(py::handle value) { return PyList_Check(value.ptr()) || PyTuple_Check(value.ptr()); }
bool is_nan(py::handle value) {
  if (PyComplex_Check(value.ptr())) {
    const Py_complex z = PyComplex_AsCComplex(value.ptr());
    return std::isnan(z.real) || std::isnan(z.imag);
  }
  return PyFloat_Check(value.ptr()) && std::isnan(PyFloat_AS_DOUBLE(value.ptr()));
}

/// "module.name" of a function or class that is found by it; those of the program itself by the name alone.
std::string name_of(py::handle value) {
  if (!PyType_Check(value.ptr()) && !PyFunction_Check(value.ptr()) && !PyCFunction_Check(value.ptr()))
    return {};
  const py::object module = py::getattr(value, "__module__", py::none());
  const py::object path = py::getattr(value, "__qualname__", py::none());
  if (!py::isinstance<py::str>(module) || !py::isinstance<py::str>(path)) return {};
  py::object found = py::module_::import("sys").attr("modules").attr("get")(module);
  for (const auto& part : path.attr("split")(".")) found = py::getattr(found, part, py::none());
  if (!found.is(value)) return {};
  const auto home = module.cast<std::string>(), name = path.cast<std::string>();
  return home == "__main__" || home == "builtins" ? name : home + "." + name;
}

/// Python's own words for an object, without the address that every process has another of.
std::string without_address(std::string words) {
  const std::string mark = " at 0x";
  for (auto at = words.find(mark); at != std::string::npos; at = words.find(mark, at)) {
    auto end = at + mark.size();
    while (end < words.size() && std::isxdigit(static_cast<unsigned char>(words[end])) != 0) ++end;
    words.erase(at, end - at);
  }
  return words;
}

std::string code_of(py::handle given);

/// "[1, 2]", or "(1,)" where one value needs its comma.
std::string code_of_entries(py::handle sequence, char first, char last, bool comma) {
  std::string code(1, first);
  std::size_t k = 0;
  for (const auto& one : sequence) code += (k++ > 0 ? ", " : "") + code_of(one);
  return code + (comma && k == 1 ? "," : "") + last;
}

/// In the order of their codes: equal sets may list what they hold in any.
std::string code_of_set(py::handle set) {
  std::vector<std::string> entries;
  for (const auto& one : set) entries.push_back(code_of(one));
  std::sort(entries.begin(), entries.end());
  std::string code;
  for (const std::string& one : entries) code += (code.empty() ? "{" : ", ") + one;
  if (!entries.empty()) code += "}";
  return PySet_Check(set.ptr()) && !entries.empty()
             ? code
             : py::str(py::type::of(set).attr("__name__")).cast<std::string>() + "(" + code + ")";
}

std::string code_of(py::handle given) {
  const Deeper deeper;
  const py::object value = listed(given);
  if (PyList_CheckExact(value.ptr())) return code_of_entries(value, '[', ']', false);
  if (PyTuple_CheckExact(value.ptr())) return code_of_entries(value, '(', ')', true);
  if (PyDict_CheckExact(value.ptr())) {
    std::string code;
    for (const auto& [key, one] : py::reinterpret_borrow<py::dict>(value))
      code += (code.empty() ? "" : ", ") + code_of(key) + ": " + code_of(one);
    return "{" + code + "}";
  }
  if (PyAnySet_CheckExact(value.ptr())) return code_of_set(value);
  if (PyUnicode_Check(value.ptr())) return py::repr(value).cast<std::string>();
  if (py::isinstance(value, py::module_::import("pathlib").attr("PurePath")))
    return "Path(" + py::repr(py::str(value)).cast<std::string>() + ")";
  if (const auto name = name_of(value); !name.empty()) return name;
  return without_address(py::repr(value).cast<std::string>());
}

bool same_entries(py::handle a, py::handle b) {
  if (PyList_Check(a.ptr()) != PyList_Check(b.ptr()) || py::len(a) != py::len(b)) return false;
  const auto end = py::iter(a).end();
  for (auto x = py::iter(a), y = py::iter(b); x != end; ++x, ++y)
    if (!same(*x, *y)) return false;
  return true;
}

bool same_tables(const py::dict& a, const py::dict& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [key, value] : a)
    if (!b.contains(key) || !same(value, b[key])) return false;
  return true;
}

/// What Python says, and no where it raises (a table compares entry by entry, and has no one answer).
bool equal(py::handle a, py::handle b) {
  const int found = PyObject_RichCompareBool(a.ptr(), b.ptr(), Py_EQ);
  if (found < 0 && PyErr_ExceptionMatches(PyExc_Exception) == 0) throw py::error_already_set();
  if (found < 0) PyErr_Clear();
  return found > 0;
}

/// Of what Python has a number for; all others share one.
Py_hash_t hash_of(py::handle value) {
  const auto kept = PySet_Check(value.ptr()) ? py::reinterpret_steal<py::object>(PyFrozenSet_New(value.ptr()))
                                             : py::reinterpret_borrow<py::object>(value);
  const Py_hash_t found = PyObject_Hash(kept.ptr());
  if (found == -1 && PyErr_ExceptionMatches(PyExc_Exception) == 0) throw py::error_already_set();
  if (found == -1) PyErr_Clear();
  return found == -1 ? 1 : found;
}

}  // namespace

std::string as_code(const std::string& maker, const py::dict& arguments) {
  std::string code = maker + "(";
  bool first = true;
  for (const auto& [name, value] : arguments) {
    code += (first ? "" : ", ") + name.cast<std::string>() + "=" + code_of(value);
    first = false;
  }
  return code + ")";
}

bool same(py::handle one, py::handle other) {
  if (one.is(other)) return true;
  const Deeper deeper;
  const py::object a = listed(one), b = listed(other);
  if (is_sequence(a) && is_sequence(b)) return same_entries(a, b);
  if (PyDict_Check(a.ptr()) && PyDict_Check(b.ptr()))
    return same_tables(py::reinterpret_borrow<py::dict>(a), py::reinterpret_borrow<py::dict>(b));
  return (is_nan(a) && is_nan(b)) || equal(a, b);
}

Py_hash_t alike(py::handle given) {
  const Deeper deeper;
  const py::object value = listed(given);
  std::uint64_t found = 1;
  if (is_sequence(value)) {
    for (const auto& one : value) found = found * 1000003U + static_cast<std::uint64_t>(alike(one));
  } else if (PyDict_Check(value.ptr())) {  // in any order
    for (const auto& [key, one] : py::reinterpret_borrow<py::dict>(value))
      found += static_cast<std::uint64_t>(alike(key)) * 31U ^ static_cast<std::uint64_t>(alike(one));
  } else if (!is_nan(value)) {
    return hash_of(value);
  }
  return static_cast<Py_hash_t>(found);
}
