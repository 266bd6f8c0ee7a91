// SPDX-License-Identifier: Apache-2.0
// Long computations from Python: a budget of seconds, and Ctrl-C ends them.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "garrison/core/budget.hpp"

namespace garrison {

/// Whether Ctrl-C was pressed; takes the GIL, and the interrupt: it is to be raised when the computation has
/// ended.
inline bool interrupt_taken() {
  const pybind11::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() == 0) return false;
  PyErr_Clear();
  return true;
}

/// Tells a Python function about once a second how long something takes: progress(what, seconds). What it
/// raises ends the computation, and is raised then. Needs the GIL to be made and destroyed, not to be asked.
class Telling {
 public:
  Telling(pybind11::object progress, std::string what)
      : progress_(std::move(progress)), what_(std::move(what)) {}

  /// Whether the computation is to end.
  bool ends() {
    if (progress_.is_none() || std::chrono::steady_clock::now() < next_) return false;
    next_ = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    const pybind11::gil_scoped_acquire gil;
    try {
      progress_(what_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
      return false;
    } catch (...) {
      raised_ = std::current_exception();
      return true;
    }
  }
  void raise() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  pybind11::object progress_;
  std::string what_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point next_ = start_ + std::chrono::seconds(1);
  std::exception_ptr raised_;
};

/// `compute` without the GIL, within `seconds` (inf = no limit) and the budget of the caller; Ctrl-C ends it
/// and is raised.
template <class Compute>
auto within_budget(double seconds, Compute&& compute, Telling telling = {pybind11::none(), ""}) {
  bool interrupted = false;
  const auto raise = [&] {
    telling.raise();
    if (!interrupted) return;
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw pybind11::error_already_set();
  };
  const Budget budget(seconds, [outer = current_budget(), &interrupted, &telling] {
    return outer.over() || (interrupted = interrupt_taken()) || telling.ends();
  });
  try {
    auto result = [&] {
      const pybind11::gil_scoped_release no_gil;
      const BudgetScope scope(budget);
      return std::forward<Compute>(compute)();
    }();
    raise();
    return result;
  } catch (const Error&) {  // stopped without a result: the interrupt is what happened
    raise();
    throw;
  }
}

}  // namespace garrison
