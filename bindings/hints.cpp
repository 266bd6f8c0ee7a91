// SPDX-License-Identifier: Apache-2.0
#include "hints.hpp"

#include <set>
#include <string>
#include <vector>

#include "garrison/core/params.hpp"

namespace py = pybind11;

namespace {

std::set<PyTypeObject*>& hinted() {
  static auto* all = new std::set<PyTypeObject*>;  // as long as the process
  return *all;
}

std::string name_of(PyTypeObject* type) {
  const std::string name = type->tp_name;
  return name.substr(name.rfind('.') + 1);
}

/// The public name of the class that is nearest to `wanted`; empty where there is none.
std::string nearest(PyTypeObject* type, const std::string& wanted) {
  const auto all = py::reinterpret_steal<py::list>(PyObject_Dir(reinterpret_cast<PyObject*>(type)));
  std::vector<std::string> known;
  for (const auto& one : all)
    if (auto name = one.cast<std::string>(); !name.starts_with('_')) known.push_back(std::move(name));
  return garrison::nearest_name(wanted, known);
}

/// Adds the nearest name to the AttributeError that is set. Names with an underscore in front are questions
/// of libraries (copy, numpy, notebooks), not slips.
void explain(PyTypeObject* type, PyObject* name, const std::string& owner) {
  if (PyErr_ExceptionMatches(PyExc_AttributeError) == 0 || !PyUnicode_Check(name)) return;
  py::error_already_set error;
  try {
    const auto wanted = py::reinterpret_borrow<py::str>(name).cast<std::string>();
    const std::string near = wanted.starts_with('_') ? "" : nearest(type, wanted);
    if (near.empty()) return error.restore();
    const std::string words = owner + " has no attribute '" + wanted + "'; did you mean \"" + near + "\"?";
    PyErr_SetString(PyExc_AttributeError, words.c_str());
  } catch (const std::exception&) {  // a name that is no text, or no memory: the error as it was
    error.restore();
  }
}

PyObject* get(PyObject* self, PyObject* name) {
  PyObject* found = PyObject_GenericGetAttr(self, name);
  // Subclasses written in Python have attributes of their own, and are asked in every step.
  if (found == nullptr && hinted().count(Py_TYPE(self)) != 0)
    explain(Py_TYPE(self), name, "'" + name_of(Py_TYPE(self)) + "' object");
  return found;
}

PyTypeObject* plain_meta = nullptr;  // pybind11's own

PyObject* get_of_class(PyObject* type, PyObject* name) {
  PyObject* found = plain_meta->tp_getattro(type, name);
  auto* own = reinterpret_cast<PyTypeObject*>(type);
  if (found == nullptr && hinted().count(own) != 0) explain(own, name, "the class " + name_of(own));
  return found;
}

PyObject* make(PyObject* type, PyObject* arguments, PyObject* keywords) {
  PyObject* made = plain_meta->tp_call(type, arguments, keywords);
  if (made != nullptr || PyErr_ExceptionMatches(PyExc_TypeError) == 0) return made;
  py::error_already_set error;
  const auto words = py::str(error.value()).cast<std::string>();
  if (error.trace() || words.find("must be called when overriding __init__") == std::string::npos) {
    error.restore();
    return nullptr;
  }
  const std::string text = name_of(reinterpret_cast<PyTypeObject*>(type)) +
                           ".__init__: got no call of the __init__ of its base class, expected one; write "
                           "super().__init__() as its first line";
  PyErr_SetString(py::module_::import("garrison._core").attr("InvalidInput").ptr(), text.c_str());
  return nullptr;
}

/// The class of our classes.
PyTypeObject* meta() {
  static PyTypeObject* const own = [] {
    const py::object made = py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(&PyType_Type))(
        "garrison_class", py::make_tuple(py::handle(reinterpret_cast<PyObject*>(plain_meta))), py::dict());
    auto* type = reinterpret_cast<PyTypeObject*>(made.inc_ref().ptr());
    type->tp_getattro = get_of_class;
    type->tp_call = make;
    PyType_Modified(type);
    return type;
  }();
  return own;
}

}  // namespace

void hint(py::handle type) {
  auto* own = reinterpret_cast<PyTypeObject*>(type.ptr());
  if (plain_meta == nullptr) plain_meta = Py_TYPE(type.ptr());
  own->tp_getattro = get;
  if (Py_TYPE(type.ptr()) == plain_meta) {
    Py_INCREF(meta());
    Py_SET_TYPE(type.ptr(), meta());
    Py_DECREF(plain_meta);
  }
  hinted().insert(own);
  PyType_Modified(own);
}
