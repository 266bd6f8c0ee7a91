// SPDX-License-Identifier: Apache-2.0
#include "guard.hpp"

#include <algorithm>
#include <functional>
#include <new>
#include <set>
#include <unordered_map>

#include "convert.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/params.hpp"
#include "signature.hpp"

namespace py = pybind11;
using garrison::refuse;
using Kind = ArgumentType::Kind;

namespace {

/// A bound function as it was, and what it takes.
struct Front {
  std::string name;             ///< lambda0, Model, Network.ring
  std::vector<Argument> takes;  ///< with self
  bool known = false;           ///< `takes` could be read
  bool method = false;          ///< the first one is self
  PyCFunction original = nullptr;
};

std::unordered_map<PyObject*, Front>& fronts() {
  static auto* all = new std::unordered_map<PyObject*, Front>;  // as long as the process
  return *all;
}

py::object read(const ArgumentType& type, const std::string& which, py::handle given);

/// Arguments in which nan says that something is missing, or inf that something is impossible.
bool may_be_missing(const std::string& which) {
  static const std::set<std::string, std::less<>> names{
      "cost", "delta", "disturbances", "measured", "measurements", "raw", "residuals", "truth", "y"};
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
                                            : py::object(py::list(py::reinterpret_borrow<py::object>(given))),
                                        "a list of numbers");
    if (numbers.ndim() != 1)
      refuse(which, "an array of shape " + py::str(numbers.attr("shape")).cast<std::string>(),
             "a list of numbers");
    return numbers.attr("tolist")();
  }
  std::size_t k = 0;
  for (const auto& one : py::list(py::reinterpret_borrow<py::object>(given)))
    all.append(read_entry(inner, which + "[" + std::to_string(k++) + "]", one));
  return all;
}

py::object read_tuple(const ArgumentType& type, const std::string& which, py::handle given) {
  const bool can =
      py::hasattr(given, "__iter__") && !PyUnicode_Check(given.ptr()) && !PyDict_Check(given.ptr());
  const py::list parts = can ? py::list(py::reinterpret_borrow<py::object>(given)) : py::list();
  if (parts.size() != type.of.size())
    refuse(which, can ? std::to_string(parts.size()) + " values" : convert::shown(given), type.expected());
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

/// The value as the C++ side takes it; a refusal where it cannot.
py::object read(const ArgumentType& type, const std::string& which, py::handle given) {
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
      return py::list(py::reinterpret_borrow<py::object>(given));
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

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "none" : all;
}

/// A call as it came: positional values, then those with a keyword.
struct Call {
  std::vector<py::handle> positional;
  std::vector<std::pair<py::handle, py::handle>> named;
};

/// The values in the order of `front.takes`; null where the default is to be taken.
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
    const std::string which = front.name + "." + argument.name;
    if (!values[k] && argument.required) refuse(which, "nothing", argument.type.expected());
    if (!values[k]) continue;
    all[k] = self && front.name.find('.') == std::string::npos  // a constructor: the object is still empty
                 ? py::reinterpret_borrow<py::object>(values[k])
                 : read(argument.type, which, values[k]);
  }
  return all;
}

/// Calls the bound function with values that have been read.
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

/// A whole number too large or too small is what passes `read` and fails after it.
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

void raise(const char* type, const std::string& message) {
  const py::object error = py::module_::import("garrison._core").attr(type);
  PyErr_SetString(error.ptr(), message.c_str());
}

/// What pybind11 and the C++ library raise, in our words. Exceptions from Python code (a callback) have a
/// traceback and pass.
void translate(const Front& front, const std::vector<py::object>& values) {
  py::error_already_set error;
  const std::string words = error.value() ? py::str(error.value()).cast<std::string>() : "";
  const auto is = [&](PyObject* type) { return error.type().ptr() == type && !error.trace(); };
  if (is(PyExc_TypeError) && (words.find("incompatible function arguments") != std::string::npos ||
                              words.find("incompatible constructor arguments") != std::string::npos))
    raise("InvalidInput", blame(front, values));
  else if (is(PyExc_MemoryError) || (is(PyExc_ValueError) && words.find("vector") != std::string::npos))
    raise("InvalidInput",
          front.name + ": got sizes that take more memory than there is, expected smaller ones");
  else if (is(PyExc_RuntimeError) || is(PyExc_IndexError) || is(PyExc_ValueError) || is(PyExc_TypeError))
    raise("Error", front.name + ": got an unexpected failure (" + words +
                       "), expected none; this is a bug of garrison");
  else
    error.restore();
}

PyObject* run(PyObject* self, const Call& call, bool fast) {
  const Front& front = fronts().at(self);
  try {
    std::vector<py::object> values = sorted_values(front, call);
    PyObject* result = call_original(front, self, values, fast);
    if (result == nullptr) translate(front, values);
    return result;
  } catch (const garrison::InvalidInput& error) {
    raise("InvalidInput", error.what());
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const std::bad_alloc&) {
    raise("InvalidInput",
          front.name + ": got sizes that take more memory than there is, expected smaller ones");
  } catch (const std::exception& error) {
    raise("Error", front.name + ": got an unexpected failure (" + error.what() +
                       "), expected none; this is a bug of garrison");
  }
  return nullptr;
}

PyObject* run_fast(PyObject* self, PyObject* const* values, Py_ssize_t positional, PyObject* keywords) {
  Call call;
  call.positional.assign(values, values + positional);
  for (Py_ssize_t k = 0; keywords != nullptr && k < PyTuple_GET_SIZE(keywords); ++k)
    call.named.emplace_back(PyTuple_GET_ITEM(keywords, k), values[positional + k]);
  return run(self, call, true);
}

PyObject* run_slow(PyObject* self, PyObject* positional, PyObject* keywords) {
  Call call;
  for (const auto& one : py::reinterpret_borrow<py::tuple>(positional)) call.positional.push_back(one);
  if (keywords != nullptr)
    for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(keywords))
      call.named.emplace_back(name, value);
  return run(self, call, false);
}

int refuse_to_make(PyObject* self, PyObject*, PyObject*) {
  const std::string name = Py_TYPE(self)->tp_name;
  raise("InvalidInput",
        name.substr(name.rfind('.') + 1) + ": got a call, expected none; objects of this class are results");
  return -1;
}

PyCFunctionObject* function_of(py::handle object) {
  if (PyInstanceMethod_Check(object.ptr())) object = PyInstanceMethod_GET_FUNCTION(object.ptr());
  if (!PyCFunction_Check(object.ptr())) return nullptr;
  auto* function = reinterpret_cast<PyCFunctionObject*>(object.ptr());
  const bool bound_by_us = function->m_self != nullptr && (function->m_ml->ml_flags & METH_KEYWORDS) != 0;
  return bound_by_us ? function : nullptr;
}

void guard_function(py::handle object, const std::string& name, const Classes& classes, bool method) {
  PyCFunctionObject* function = function_of(object);
  if (function == nullptr || fronts().count(function->m_self) != 0) return;
  const py::object doc = object.attr("__doc__");
  const std::string text = doc.is_none() ? "" : doc.cast<std::string>();
  auto takes = parse_signature(std::string_view(text).substr(0, text.find('\n')), classes);
  if (!takes) return;
  Front front;
  front.name = name;
  front.takes = std::move(*takes);
  front.method = method;
  if (method && !front.takes.empty()) front.takes.front().name = "self";  // of a property: arg0
  front.original = function->m_ml->ml_meth;
  const bool fast = (function->m_ml->ml_flags & METH_FASTCALL) != 0;
  function->m_ml->ml_meth = fast ? reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(run_fast))
                                 : reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(run_slow));
  fronts().emplace(function->m_self, std::move(front));
}

void guard_class(py::handle type, const Classes& classes) {
  const auto name = type.attr("__name__").cast<std::string>();
  const py::dict entries(type.attr("__dict__"));
  // Python fills in a wrapper of its own where there is no constructor.
  if (!entries.contains("__init__") ||
      Py_TYPE(entries["__init__"].cast<py::object>().ptr()) == &PyWrapperDescr_Type)
    reinterpret_cast<PyTypeObject*>(type.ptr())->tp_init = refuse_to_make;
  for (const auto& [key, value] : entries) {
    const auto entry = key.cast<std::string>();
    const std::string full = entry == "__init__" ? name : name + "." + entry;
    if (Py_TYPE(value.ptr()) == &PyStaticMethod_Type)
      guard_function(value.attr("__func__"), full, classes, false);
    else if (Py_TYPE(value.ptr()) == &PyProperty_Type && !value.attr("fget").is_none())
      guard_function(value.attr("fget"), full, classes, true);
    else
      guard_function(value, full, classes, true);
  }
}

/// Calls `each(name, object)` for what the module and its submodules hold.
void walk(const py::module_& module, const std::function<void(const std::string&, py::handle)>& each) {
  const auto own = module.attr("__name__").cast<std::string>();
  for (const auto& [key, value] : module.attr("__dict__").cast<py::dict>()) {
    const auto name = key.cast<std::string>();
    if (PyModule_Check(value.ptr())) {
      const auto sub = py::reinterpret_borrow<py::module_>(value);
      if (sub.attr("__name__").cast<std::string>().starts_with(own + ".")) walk(sub, each);
    } else {
      each(name, value);
    }
  }
}

}  // namespace

void guard(const py::module_& module) {
  Classes classes;
  walk(module, [&](const std::string&, py::handle value) {
    if (PyType_Check(value.ptr()) && !PyExceptionClass_Check(value.ptr()))
      classes[value.attr("__module__").cast<std::string>() + "." +
              value.attr("__qualname__").cast<std::string>()] = value;
  });
  for (const auto& [name, type] : classes) guard_class(type, classes);
  walk(module,
       [&](const std::string& name, py::handle value) { guard_function(value, name, classes, false); });
}
