// SPDX-License-Identifier: Apache-2.0
// A bound function with the arguments that it takes, and a call of it.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "signature.hpp"

/// A bound function as it was, and what it takes.
struct Front {
  std::string name;             ///< lambda0, Model, Network.ring
  std::vector<Argument> takes;  ///< with self
  bool method = false;          ///< the first one is self
  PyCFunction original = nullptr;
};

/// A call as it came: positional values, then those with a keyword.
struct Call {
  std::vector<pybind11::handle> positional;
  std::vector<std::pair<pybind11::handle, pybind11::handle>> named;
};

/// The values in the order of `front.takes`, read; null where the default is to be taken.
/// @throws InvalidInput for a value, a number of values or a name that does not fit
std::vector<pybind11::object> sorted_values(const Front& front, const Call& call);
/// Calls the bound function with values that have been read.
PyObject* call_original(const Front& front, PyObject* self, const std::vector<pybind11::object>& values,
                        bool fast);
/// Says what pybind11 did not take although it could be read: a whole number out of range, as a rule.
std::string blame(const Front& front, const std::vector<pybind11::object>& values);
