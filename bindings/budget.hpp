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

}  // namespace garrison
