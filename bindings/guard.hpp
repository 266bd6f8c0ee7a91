// SPDX-License-Identifier: Apache-2.0
// One layer in front of every bound function: which argument, what it got, what it expected.
#pragma once

#include <pybind11/pybind11.h>

/// Puts the layer in front of all functions, methods and properties of the module, its classes and its
/// submodules. Called last: what is bound before is in. From then on arguments are read by convert.hpp,
/// misspelt ones are refused with the nearest name, and no exception of pybind11 or the C++ library passes.
void guard(const pybind11::module_& module);
