// SPDX-License-Identifier: Apache-2.0
// Misspelt attributes of classes and objects are refused with the nearest name.
#pragma once

#include <pybind11/pybind11.h>

/// From now on an attribute that neither the class nor an object of it has is an AttributeError that names
/// the nearest one, and a subclass written in Python whose __init__ forgets that of the base is refused in
/// our words.
void hint(pybind11::handle type);
