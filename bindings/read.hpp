// SPDX-License-Identifier: Apache-2.0
// A Python value as the argument of a bound function.
#pragma once

#include "signature.hpp"

/// The value as the C++ side takes it, read by convert.hpp. `which` names the argument.
/// @throws InvalidInput where it is of another kind, nan or so large that its square overflows
pybind11::object read(const ArgumentType& type, const std::string& which, pybind11::handle given);
