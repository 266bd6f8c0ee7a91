// SPDX-License-Identifier: Apache-2.0
// `with garrison.budget(seconds):` sets the budget of everything that this thread computes inside.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "budget.hpp"

namespace garrison {

/// A budget between __enter__ and __exit__. Ctrl-C ends the computation that is polling; the interrupt is
/// raised when the block is left.
class TimeLimit {
 public:
  explicit TimeLimit(double seconds) : seconds_(seconds) { Budget{seconds}; }
  void enter() {
    interrupted_ = std::make_shared<bool>(false);
    budget_ = Budget(seconds_, [interrupted = interrupted_] { return *interrupted = interrupt_taken(); });
    scope_ = std::make_unique<BudgetScope>(budget_);
  }
  void leave() {
    scope_.reset();
    if (!*interrupted_) return;
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw pybind11::error_already_set();
  }
  bool over() const { return budget_.over(); }

 private:
  double seconds_;
  std::shared_ptr<bool> interrupted_ = std::make_shared<bool>(false);
  Budget budget_;
  std::unique_ptr<BudgetScope> scope_;
};

}  // namespace garrison
