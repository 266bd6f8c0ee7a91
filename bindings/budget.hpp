// SPDX-License-Identifier: Apache-2.0
// Long computations from Python: a budget of seconds, and Ctrl-C ends them.
#pragma once

#include <pybind11/pybind11.h>

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

/// `compute` without the GIL, within `seconds` (inf = no limit) and the budget of the caller; Ctrl-C ends it
/// and is raised.
template <class Compute>
auto within_budget(double seconds, Compute&& compute) {
  bool interrupted = false;
  const auto raise = [&] {
    if (!interrupted) return;
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw pybind11::error_already_set();
  };
  const Budget budget(seconds, [outer = current_budget(), &interrupted] {
    return outer.over() || (interrupted = interrupt_taken());
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
