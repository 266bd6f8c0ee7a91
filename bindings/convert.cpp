// SPDX-License-Identifier: Apache-2.0
#include "convert.hpp"

#include <limits>
#include <optional>

#include "garrison/core/error.hpp"

namespace convert {

using garrison::refuse;

namespace {

py::object numpy(const char* name) { return py::module_::import("numpy").attr(name); }

/// Calls Python and returns a null object instead of an exception of its own.
template <class Call>
py::object attempt(const Call& call) {
  try {
    return call();
  } catch (const py::error_already_set& error) {
    if (error.matches(PyExc_KeyboardInterrupt)) throw;
    return {};
  }
}

bool is_bool(py::handle given) { return PyBool_Check(given.ptr()) || py::isinstance(given, numpy("bool_")); }

bool is_masked_array(py::handle given) { return py::isinstance(given, numpy("ma").attr("MaskedArray")); }

bool is_text(py::handle given) {
  return PyUnicode_Check(given.ptr()) || PyBytes_Check(given.ptr()) || PyByteArray_Check(given.ptr());
}

bool is_complex(py::handle given) {
  return PyComplex_Check(given.ptr()) || py::isinstance(given, numpy("complexfloating"));
}

/// Something that a list of records holds where nothing was recorded.
bool is_nothing(py::handle given) {
  if (given.is_none()) return true;
  const std::string type = Py_TYPE(given.ptr())->tp_name;
  return type == "NAType" || type == "NaTType" || type.ends_with(".NAType") || type.ends_with(".NaTType") ||
         (is_masked_array(given) && type.ends_with("MaskedConstant"));
}

std::string dtype_name(const py::array& a) { return py::str(a.dtype()).cast<std::string>(); }

Array from_objects(const std::string& which, const py::array& given) {
  const py::object flat = given.attr("ravel")();
  const auto size = static_cast<py::ssize_t>(py::len(flat));
  py::array_t<double> numbers(size);
  for (py::ssize_t k = 0; k < size; ++k) {
    const py::object one = flat[py::int_(k)];
    numbers.mutable_at(k) = is_nothing(one) ? garrison::kNaN : number(which, one);
  }
  return Array(numbers.attr("reshape")(given.attr("shape")));
}

/// Place of the first True or False in nested lists, as "[0][1]"; nothing where there is none.
std::optional<std::string> flag_in(py::handle value) {
  if (PyBool_Check(value.ptr())) return "";
  if (!PyList_Check(value.ptr()) && !PyTuple_Check(value.ptr())) return std::nullopt;
  std::size_t k = 0;
  for (const auto& one : py::reinterpret_borrow<py::sequence>(value)) {
    if (const auto found = flag_in(one)) return "[" + std::to_string(k) + "]" + *found;
    ++k;
  }
  return std::nullopt;
}

bool is_sparse(py::handle given) { return py::hasattr(given, "toarray") && py::hasattr(given, "shape"); }

/// Refuses what cannot be held with all its entries as doubles, as views of one number may pretend to.
void require_room(const std::string& which, py::handle given) {
  const py::object shape = attempt([&] { return py::object(given.attr("shape")); });
  if (!shape || !py::isinstance<py::tuple>(shape)) return;
  double entries = 1.0;
  for (const auto& length : shape) {
    if (!PyLong_Check(length.ptr())) return;
    entries *= length.cast<double>();
  }
  garrison::require_memory(which,
                           (is_sparse(given) ? "a sparse matrix of shape " : "an array of shape ") +
                               py::str(shape).cast<std::string>(),
                           8.0 * entries);
}

/// An ndarray of any dtype, with nan where entries are masked.
py::array plain(const std::string& which, py::handle given, const std::string& expected) {
  py::object x = py::reinterpret_borrow<py::object>(given);
  require_room(which, x);
  if (is_sparse(x)) x = x.attr("toarray")();
  if (is_masked_array(x)) {
    const auto kind = x.attr("dtype").attr("kind").cast<std::string>();
    if (std::string("biuf").find(kind) != std::string::npos)
      x = x.attr("astype")("float64").attr("filled")(garrison::kNaN);
    else if (kind == "O")
      x = x.attr("filled")(py::none());
  }
  const py::object read = attempt([&] { return numpy("asarray")(x); });
  if (!read) refuse(which, shown(given) + " (rows of different lengths?)", expected);
  return py::reinterpret_borrow<py::array>(read);
}

}  // namespace

std::string shown(py::handle given) {
  if (given.is_none()) return "None";
  const std::string type = Py_TYPE(given.ptr())->tp_name;
  const bool ours = type.starts_with("garrison.");
  if (ours) return "a " + type.substr(type.rfind('.') + 1);
  const bool function = PyCFunction_Check(given.ptr()) || PyFunction_Check(given.ptr());
  if (function || PyType_Check(given.ptr())) {
    const py::object name = attempt([&] { return py::object(given.attr("__name__")); });
    const std::string words = name ? py::str(name).cast<std::string>() : "without a name";
    return function ? "the function " + words + ", not called yet" : "the class " + words + ", not made yet";
  }
  if (py::isinstance<py::array>(given)) {
    const auto a = py::reinterpret_borrow<py::array>(given);
    if (a.ndim() > 0 && a.size() != 1)
      return "an array of shape " + py::str(a.attr("shape")).cast<std::string>();
  }
  const py::object text = attempt([&] {  // numpy writes its numbers as np.float64(nan)
    const bool number_of_numpy = py::isinstance(given, numpy("generic"));
    return py::object(py::repr(number_of_numpy ? py::object(given.attr("item")())
                                               : py::reinterpret_borrow<py::object>(given)));
  });
  constexpr std::size_t most = 60;
  std::string words = text ? text.cast<std::string>() : "an object of class " + type;
  if (words.size() > most || words.find('\n') != std::string::npos)
    words =
        "an object of class " + type.substr(type.rfind('.') == std::string::npos ? 0 : type.rfind('.') + 1);
  return words;
}

bool scalar(py::handle given) {
  if (!py::hasattr(given, "__iter__")) return true;
  return py::isinstance<py::array>(given) && py::reinterpret_borrow<py::array>(given).ndim() == 0;
}

py::list listed(const std::string& which, py::handle given, const std::string& expected) {
  constexpr double kEntry = 40.0;  // bytes of a reference and a number
  if (is_sparse(given))
    refuse(which, "a sparse matrix", expected, "take .toarray(), or the numbers that are meant");
  require_room(which, given);
  Py_ssize_t length = PyObject_LengthHint(given.ptr(), 0);
  if (length < 0) {
    const bool beyond = PyErr_ExceptionMatches(PyExc_OverflowError) != 0;
    PyErr_Clear();
    length = beyond ? std::numeric_limits<Py_ssize_t>::max() : 0;
  }
  garrison::require_memory(which, garrison::text(static_cast<double>(length)) + " entries",
                           kEntry * static_cast<double>(length));
  try {
    return {py::reinterpret_borrow<py::object>(given)};
  } catch (const py::error_already_set& error) {  // what a generator raises is its owner's
    if (!error.matches(PyExc_TypeError)) throw;
    refuse(which, shown(given), expected);
  }
}

double number(const std::string& which, py::handle given) {
  const char* expected = "a number";
  if (PyFloat_CheckExact(given.ptr())) return PyFloat_AS_DOUBLE(given.ptr());
  if (is_complex(given)) refuse(which, shown(given), "a real number");
  if (given.is_none() || is_bool(given) || is_text(given) || is_nothing(given))
    refuse(which, shown(given), expected);
  if (py::hasattr(given, "ndim") && !py::isinstance<py::int_>(given.attr("ndim")))
    refuse(which, shown(given), expected);
  if (py::hasattr(given, "ndim") && given.attr("ndim").cast<py::ssize_t>() > 0)
    refuse(which, shown(given), expected);
  if (py::hasattr(given, "dtype") && py::hasattr(given.attr("dtype"), "kind")) {
    const py::object kind = given.attr("dtype").attr("kind");
    if (py::isinstance<py::str>(kind) &&
        std::string("biuf").find(kind.cast<std::string>()) == std::string::npos)
      refuse(which, shown(given), expected);
  }
  const double value = PyFloat_AsDouble(given.ptr());
  if (value == -1.0 && PyErr_Occurred() != nullptr) {
    const bool large = PyErr_ExceptionMatches(PyExc_OverflowError) != 0;
    PyErr_Clear();
    refuse(which, shown(given), large ? "a number below 1.8e308" : expected);
  }
  return value;
}

py::int_ whole(const std::string& which, py::handle given) {
  const char* expected = "a whole number";
  if (is_bool(given)) refuse(which, shown(given), expected);
  if (PyLong_CheckExact(given.ptr())) return py::reinterpret_borrow<py::int_>(given);
  if (PyIndex_Check(given.ptr())) {
    const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
    if (index) return index;
    PyErr_Clear();
    const bool lone = py::isinstance<py::array>(given) &&
                      py::reinterpret_borrow<py::array>(given).dtype().kind() == 'f';  // array(3.0)
    if (!lone) refuse(which, shown(given), expected);
  }
  const double value = given.is_none() ? garrison::kNaN : [&] {
    try {
      return number(which, given);
    } catch (const garrison::InvalidInput&) {
      refuse(which, shown(given), expected);
    }
  }();
  if (!(value == std::floor(value)) || std::abs(value) > 9.007199254740992e15)
    refuse(which, shown(given), expected);
  return py::int_(static_cast<std::int64_t>(value));
}

std::int64_t large(const std::string& which, py::handle given) {
  const py::int_ value = whole(which, given);
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
  if (overflow != 0) refuse(which, shown(given), "a whole number between -9.2e18 and 9.2e18");
  return number;
}

int small(const std::string& which, py::handle given) {
  const std::int64_t number = large(which, given);
  constexpr int most = std::numeric_limits<int>::max();
  if (number < -most || number > most)
    refuse(which, shown(given), "a whole number of at most " + std::to_string(most));
  return static_cast<int>(number);
}

bool flag(const std::string& which, py::handle given) {
  if (given.ptr() == Py_True) return true;
  if (given.ptr() == Py_False) return false;
  if (is_bool(given)) return PyObject_IsTrue(given.ptr()) == 1;
  if (PyLong_CheckExact(given.ptr())) {
    const long value = PyLong_AsLong(given.ptr());
    if (value == 0 || value == 1) return value == 1;
    PyErr_Clear();
  }
  refuse(which, shown(given), "True or False");
}

std::string words(const std::string& which, py::handle given) {
  if (!PyUnicode_Check(given.ptr())) refuse(which, shown(given), "a string");
  const py::object bytes = attempt([&] { return py::object(given.attr("encode")("utf-8")); });
  if (!bytes) refuse(which, "a string that is not valid Unicode", "a string");
  return bytes.cast<std::string>();
}

std::vector<std::string> names(const std::string& which, py::handle given) {
  if (PyUnicode_Check(given.ptr())) return {words(which, given)};
  const char* expected = "a list of names";
  if (is_text(given) || PyDict_Check(given.ptr())) refuse(which, shown(given), expected);
  const py::list all = listed(which, given, expected);
  std::vector<std::string> list;
  for (const auto& one : all) list.push_back(words(which + "[" + std::to_string(list.size()) + "]", one));
  return list;
}

Array array(const std::string& which, py::handle given, const std::string& expected) {
  if (given.is_none() || is_text(given) || PyDict_Check(given.ptr()) || PyAnySet_Check(given.ptr()))
    refuse(which, shown(given), expected);
  const py::array read = plain(which, given, expected);
  // Where all entries are flags they may be meant, as in an adjacency matrix.
  if (const auto at = read.dtype().kind() == 'b' ? std::nullopt : flag_in(given))
    refuse(which + *at, "True or False among numbers", expected);
  switch (read.dtype().kind()) {
    case 'f':
    case 'i':
    case 'u':
    case 'b':
      return Array(read);
    case 'c':
      refuse(which, "complex numbers", "real ones", "take .real where the imaginary part is 0");
    case 'O':
      if (read.ndim() == 0) refuse(which, shown(given), expected);
      return from_objects(which, read);
    default:
      refuse(which, "entries of type " + dtype_name(read), expected);
  }
}

Array matrix(const std::string& which, py::handle given) {
  const std::string expected = "a matrix of numbers (rows x columns)";
  if (const auto at = flag_in(given)) refuse(which + *at, "True or False", expected);
  const Array a = array(which, given, expected);
  if (a.ndim() > 2)
    refuse(which, "an array of shape " + py::str(a.attr("shape")).cast<std::string>(), expected);
  return a.ndim() == 0 ? Array(a.attr("reshape")(1, 1)) : a;
}

Array vector(const std::string& which, py::handle given) {
  const std::string expected = "a list of numbers";
  if (const auto at = flag_in(given)) refuse(which + *at, "True or False", expected);
  const Array a = array(which, given, expected);
  const bool line = a.ndim() < 2 || (a.ndim() == 2 && (a.shape(0) == 1 || a.shape(1) == 1));
  if (!line) refuse(which, "an array of shape " + py::str(a.attr("shape")).cast<std::string>(), expected);
  return a.ndim() == 1 ? a : Array(a.attr("reshape")(-1));
}

garrison::Matrix eigen(const Array& array) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const bool empty = array.size() == 0;
  const auto rows = array.ndim() == 0 ? 1 : empty && array.ndim() == 1 ? 0 : array.shape(0);
  const auto columns = array.ndim() == 2 ? array.shape(1) : empty ? 0 : 1;
  return Eigen::Map<const Rows>(array.data(), rows, columns);
}

}  // namespace convert
