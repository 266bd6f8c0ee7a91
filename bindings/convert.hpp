// SPDX-License-Identifier: Apache-2.0
// What Python hands over, as numbers: each function refuses what it cannot read without a loss, in the
// project's form. `which` names the argument.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>
#include <vector>

#include "garrison/core/types.hpp"

namespace convert {

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A value as a message shows it: short, an array by its shape, an object of ours by its class.
std::string shown(py::handle given);

/// One value: nothing to iterate over, or an array without dimensions.
bool scalar(py::handle given);

/// What can be iterated over, as a list; no sparse matrix. Refuses, with the memory it would take, what is
/// too long (`range(10**10)`); `expected` ends a refusal.
py::list listed(const std::string& which, py::handle given, const std::string& expected);

/// A real number; no bool, text, complex or masked value.
double number(const std::string& which, py::handle given);
/// A whole number of any size (2.0 is one); no bool.
py::int_ whole(const std::string& which, py::handle given);
/// The same within the range of int.
int small(const std::string& which, py::handle given);
/// The same within the range of std::int64_t.
std::int64_t large(const std::string& which, py::handle given);
bool flag(const std::string& which, py::handle given);
std::string words(const std::string& which, py::handle given);
/// A list of texts; one text is a list of one.
std::vector<std::string> names(const std::string& which, py::handle given);

/// Real numbers of any shape. Masked entries, None and pandas.NA become nan; `expected` ends the refusal.
Array array(const std::string& which, py::handle given, const std::string& expected = "an array of numbers");
/// The same with two dimensions; a number is 1 x 1, a list of numbers one column, as Eigen reads it.
Array matrix(const std::string& which, py::handle given);
/// The same with one dimension (one row and one column will do).
Array vector(const std::string& which, py::handle given);

/// A two-dimensional array as Eigen holds it.
garrison::Matrix eigen(const Array& array);

}  // namespace convert
