// SPDX-License-Identifier: Apache-2.0
// Filters whose steps are Python functions: a class derived from garrison.Filter, behind the same interfaces
// as every family.
#pragma once

#include <memory>

#include "bindings.hpp"

namespace own {

/// The AnyFilter of a Python object; `handle` is the C++ part of it and lives as long as the object.
std::shared_ptr<const garrison::AnyFilter> filter_of(const FilterHandle* handle);
/// Whether the filter is one of these.
bool is_own(const garrison::AnyFilter& filter);
/// The Python object behind such a filter.
py::object object_of(const garrison::AnyFilter& filter);
/// What the user keeps in the object: its parameters.
py::dict attributes_of(const garrison::AnyFilter& filter);
/// What the user's `design` returned; None where the filter is a family.
py::object gains_of(const garrison::Prepared& prepared);
/// The filter, prepared with gains that its `design` returned before.
std::shared_ptr<const garrison::Prepared> with_gains(const garrison::AnyFilter& filter,
                                                     const garrison::Model& model,
                                                     const garrison::Network& network, py::object gains);

}  // namespace own
