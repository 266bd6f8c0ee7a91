// SPDX-License-Identifier: Apache-2.0
// Long computations from Python: a budget of seconds, and Ctrl-C ends them.
#pragma once

#include <pybind11/pybind11.h>

#include <utility>

#include "garrison/core/budget.hpp"

namespace garrison {

/// `compute` within `seconds` (inf = no limit) and the budget of the caller; a pending KeyboardInterrupt ends
/// it and is raised.
template <class Compute>
auto within_budget(double seconds, Compute&& compute) {
  const BudgetScope scope(
      Budget(seconds, [outer = current_budget()] { return outer.over() || PyErr_CheckSignals() != 0; }));
  try {
    auto result = std::forward<Compute>(compute)();
    if (PyErr_Occurred() != nullptr) throw pybind11::error_already_set();
    return result;
  } catch (const Error&) {  // stopped without a result: the interrupt is what happened
    if (PyErr_Occurred() != nullptr) throw pybind11::error_already_set();
    throw;
  }
}

/// `compute` without the GIL, within the budget of the caller; a pending KeyboardInterrupt ends it and is
/// raised.
template <class Compute>
auto without_gil(Compute&& compute) {
  bool interrupted = false;
  const auto raise = [&] {
    if (!interrupted) return;
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw pybind11::error_already_set();
  };
  try {
    auto result = [&] {
      const pybind11::gil_scoped_release no_gil;
      const BudgetScope scope(Budget(kInfinity, [outer = current_budget(), &interrupted] {
        if (outer.over()) return true;
        const pybind11::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() == 0) return false;
        PyErr_Clear();
        interrupted = true;
        return true;
      }));
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
