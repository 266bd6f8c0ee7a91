// SPDX-License-Identifier: Apache-2.0
// What the binding files share.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <memory>

#include "garrison/attacks/registry.hpp"
#include "garrison/engine/any_filter.hpp"
#include "numpydoc.hpp"

namespace py = pybind11;

void bind_core(py::module_& m);
void bind_model(py::module_& m);
void bind_network(py::module_& m);
void bind_filters(py::module_& m);
void bind_attacks(py::module_& m);
void bind_drivers(py::module_& m);
void bind_messages(py::module_& m);
void bind_agents(py::module_& m);
void bind_designs(py::module_& m);
void bind_analysis(py::module_& m);
void bind_fit(py::module_& m);
void bind_autoregression(py::module_& m);
void bind_known(py::module_& m);
void bind_rdkf(py::module_& m);
void bind_saturation(py::module_& m);
void bind_structure(py::module_& m);
void bind_structural(py::module_& m);
void bind_partial_sharing(py::module_& m);
void bind_platoon(py::module_& m);
void bind_certificate(py::module_& m);

/// A filter as Python holds it; every family has a class of its own derived from this one.
struct FilterHandle {
  virtual ~FilterHandle() = default;  // Python shows the derived class
  std::shared_ptr<const garrison::AnyFilter> filter;
};

/// A filter as Python sees it.
py::object filter_object(const garrison::AnyFilter& filter);

/// Parameters between Python and C++; `owner` names the filter or attack in a refusal.
garrison::ParamMap to_params(const std::string& owner, const py::dict& given);
py::dict from_params(const garrison::ParamMap& params);
/// Those that differ from their default, in the order of the description.
py::dict changed_params(const garrison::ParamMap& params, const std::vector<garrison::ParamInfo>& infos);
/// scalar_gain -> ScalarGain: what Python calls a family or an attack.
std::string class_name(std::string_view name);
py::list from_infos(const std::vector<garrison::ParamInfo>& infos);
/// A parameter as an item of `numpydoc`: type, unit and range.
std::string described(const garrison::ParamInfo& info);

/// The parameters of a filter that has to be of family F.
template <class F>
typename F::Params params_of(const FilterHandle& f) {
  const std::string family(F::name);
  if (f.filter->name() != family) garrison::refuse("filter", f.filter->name(), family);
  return garrison::parse_params<typename F::Params>(family, f.filter->params());
}

/// Refuses a network that has another number of agents than the model.
inline void require_same_size(const garrison::Model& model, const garrison::Network& network) {
  if (model.agents() != network.agents())
    garrison::refuse("network", garrison::amount(network.agents(), "agent"),
                     std::to_string(model.agents()) + ", because C has one matrix per agent");
}

/// Refuses a number outside of [least, most], nan included.
inline void require_range(const std::string& which, double value, double least,
                          double most = std::numeric_limits<double>::max()) {
  if (value >= least && value <= most) return;
  const bool bounded = most < std::numeric_limits<double>::max();
  garrison::refuse(which, garrison::text(value),
                   bounded ? "a number in [" + garrison::text(least) + ", " + garrison::text(most) + "]"
                           : "a finite number >= " + garrison::text(least));
}

/// A C-ordered array that owns its numbers.
template <class T, class Memory>
py::array_t<T> owned(std::vector<T, Memory>&& numbers, std::vector<py::ssize_t> shape) {
  auto* kept = new std::vector<T, Memory>(std::move(numbers));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T, Memory>*>(p); });
  return py::array_t<T>(std::move(shape), kept->data(), owner);
}
