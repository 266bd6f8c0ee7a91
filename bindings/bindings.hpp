// SPDX-License-Identifier: Apache-2.0
// What the binding files share.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>

#include "garrison/attacks/registry.hpp"
#include "garrison/engine/any_filter.hpp"

namespace py = pybind11;

void bind_core(py::module_& m);
void bind_filters(py::module_& m);
void bind_attacks(py::module_& m);
void bind_drivers(py::module_& m);
void bind_agents(py::module_& m);
void bind_analysis(py::module_& m);
void bind_fit(py::module_& m);
void bind_rdkf(py::module_& m);
void bind_structure(py::module_& m);
void bind_structural(py::module_& m);
void bind_partial_sharing(py::module_& m);
void bind_platoon(py::module_& m);
void bind_certificate(py::module_& m);

/// A filter as Python holds it; every family has a class of its own derived from this one.
struct FilterHandle {
  std::shared_ptr<const garrison::AnyFilter> filter;
};

/// Parameters between Python and C++.
garrison::ParamMap to_params(const py::dict& given);
py::dict from_params(const garrison::ParamMap& params);
py::list from_infos(const std::vector<garrison::ParamInfo>& infos);

/// A C-ordered array that owns its numbers.
template <class T, class Memory>
py::array_t<T> owned(std::vector<T, Memory>&& numbers, std::vector<py::ssize_t> shape) {
  auto* kept = new std::vector<T, Memory>(std::move(numbers));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T, Memory>*>(p); });
  return py::array_t<T>(std::move(shape), kept->data(), owner);
}
