// SPDX-License-Identifier: Apache-2.0
// What the parts that call a user's Python code share.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>

namespace own {

namespace py = pybind11;

/// A Python object that C++ may copy and drop on any thread, without the interpreter's lock.
class Held {
 public:
  Held() = default;
  explicit Held(py::object object)
      : object_(new py::object(std::move(object)), [](py::object* held) {
          const py::gil_scoped_acquire gil;
          delete held;
        }) {}
  /// To be used under the lock only.
  const py::object& operator*() const { return *object_; }
  const py::object* operator->() const { return object_.get(); }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  std::shared_ptr<py::object> object_;
};

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A fresh array with these numbers.
inline Array array_of(const double* numbers, std::size_t size) {
  return Array(static_cast<py::ssize_t>(size), numbers);
}

/// Runs `call`; an exception of the user's code goes on with its own type and traceback, and a note that says
/// where it was raised ("Mine.sense, agent 3, sample 17").
template <class Call>
auto noted(const std::string& where, const Call& call) {
  try {
    return call();
  } catch (py::error_already_set& error) {
    py::object value = error.value();
    if (py::hasattr(value, "add_note")) value.attr("add_note")("raised in " + where);
    throw;
  }
}

}  // namespace own
