// SPDX-License-Identifier: Apache-2.0
#include "guard.hpp"

#include <functional>
#include <new>
#include <unordered_map>

#include "front.hpp"
#include "garrison/core/error.hpp"
#include "hints.hpp"

namespace py = pybind11;

namespace {

std::unordered_map<PyObject*, Front>& fronts() {
  static auto* all = new std::unordered_map<PyObject*, Front>;  // as long as the process
  return *all;
}

void raise(const char* type, const std::string& message) {
  const py::object error = py::module_::import("garrison._core").attr(type);
  const auto size = static_cast<Py_ssize_t>(message.size());
  // Words of damaged files may be anything.
  const auto words =
      py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(message.data(), size, "backslashreplace"));
  PyErr_SetObject(error.ptr(), words.ptr());
}

/// What pybind11 and the C++ library raise, in our words. Exceptions from Python code (a callback) have a
/// traceback and pass.
void translate(const Front& front, const std::vector<py::object>& values) {
  py::error_already_set error;
  const std::string words = error.value() ? py::str(error.value()).cast<std::string>() : "";
  const auto is = [&](PyObject* type) { return error.type().ptr() == type && !error.trace(); };
  const bool plain = is(PyExc_KeyError) || is(PyExc_RuntimeError) || is(PyExc_IndexError) ||
                     is(PyExc_ValueError) || is(PyExc_TypeError);
  if (plain && front.name.ends_with(".__setstate__"))
    raise("InvalidInput",
          front.name + ": got a state " + (is(PyExc_KeyError) ? "without " + words : "of other types") +
              ", expected what pickle kept of an object; it is damaged, or of another version");
  else if (is(PyExc_TypeError) && (words.find("incompatible function arguments") != std::string::npos ||
                                   words.find("incompatible constructor arguments") != std::string::npos))
    raise("InvalidInput", blame(front, values));
  else if (is(PyExc_MemoryError) || (is(PyExc_ValueError) && words.find("vector") != std::string::npos))
    raise("InvalidInput",
          front.name + ": got sizes that take more memory than there is, expected smaller ones");
  else if (is(PyExc_UnicodeDecodeError))
    raise("InvalidInput", front.name + ": got words that are not UTF-8, expected text; the file is damaged");
  else if (plain && !is(PyExc_KeyError))
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

/// Objects keep what they were made with; only subclasses written in Python have attributes of their own.
int assign(PyObject* self, PyObject* name, PyObject* value) {
  if (PyObject_GenericSetAttr(self, name, value) == 0) return 0;
  if (PyErr_ExceptionMatches(PyExc_AttributeError) == 0) return -1;
  PyErr_Clear();
  const std::string type = Py_TYPE(self)->tp_name;
  raise("InvalidInput", type.substr(type.rfind('.') + 1) + "." + py::str(name).cast<std::string>() +
                            ": got an assignment, expected none; objects of this class are not changed: make "
                            "another one");
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

/// What pickle and copy ask for. Python's own would call pybind11's base class for old protocols, which ends
/// the process, and speak of bugs where a class cannot be kept.
py::tuple reduced(const py::object& self) {
  const py::type type = py::type::of(self);
  if (!py::hasattr(type, "__setstate__"))
    garrison::refuse(type.attr("__name__").cast<std::string>(), "pickle or copy", "none",
                     "objects of this class are worked with: keep what it was made from");
  return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"), py::make_tuple(type),
                        self.attr("__getstate__")());
}
void make_reducible(py::handle type) {
  py::setattr(type, "__reduce__", py::cpp_function(&reduced, py::name("__reduce__"), py::is_method(type)));
}

void guard_class(py::handle type, const Classes& classes) {
  const auto name = type.attr("__name__").cast<std::string>();
  make_reducible(type);
  const py::dict entries(type.attr("__dict__"));
  reinterpret_cast<PyTypeObject*>(type.ptr())->tp_setattro = assign;
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
  for (const auto& [name, type] : classes) {
    guard_class(type, classes);
    hint(type);
  }
  walk(module,
       [&](const std::string& name, py::handle value) { guard_function(value, name, classes, false); });
}
