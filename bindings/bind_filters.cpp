// SPDX-License-Identifier: Apache-2.0
// One Python class per filter family, its constructor derived from the fields of Params.
#include <tuple>

#include "bindings.hpp"
#include "budget.hpp"
#include "garrison/filters/lfre.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/platoon/baseline.hpp"
#include "garrison/filters/platoon/filter.hpp"
#include "garrison/filters/rdkf/filter.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/filters/scalar_gain.hpp"
#include "garrison/filters/structural/filter.hpp"

using namespace garrison;

namespace {

std::string number_range(const ParamInfo& info) {
  std::string words;
  if (std::isfinite(info.least)) words += (info.open ? ", > " : ", >= ") + text(info.least);
  if (std::isfinite(info.most)) words += ", <= " + text(info.most);
  return words;
}

template <class F>
std::string class_doc() {
  std::string doc = std::string(F::title) + ".\n\nSource: " + std::string(F::source) + "\n\n";
  for (const ParamInfo& info : describe<typename F::Params>())
    doc += info.name + ": " + info.doc + (info.unit.empty() ? "" : " [" + info.unit + "]") +
           number_range(info) + "\n";
  return doc;
}

template <class F>
struct HandleOf : FilterHandle {};

template <class F, class... P, class... T, std::size_t... I>
void bind_filter(py::module_& m, const char* name, [[maybe_unused]] const std::tuple<Field<P, T>...>& fields,
                 std::index_sequence<I...>) {
  const static std::string doc = class_doc<F>();
  py::class_<HandleOf<F>, FilterHandle> bound(m, name, doc.c_str());
  const auto make = [](T... given) {
    typename F::Params p;
    [[maybe_unused]] const auto all = F::Params::fields();
    ((p.*(std::get<I>(all).member) = std::move(given)), ...);
    HandleOf<F> handle;
    handle.filter = make_filter(std::string(F::name), values(p));
    return handle;
  };
  if constexpr (sizeof...(T) == 0)
    bound.def(py::init(make));
  else
    bound.def(py::init(make), py::kw_only(),
              (py::arg(std::get<I>(fields).info.name.c_str()) =
                   typename F::Params{}.*(std::get<I>(fields).member))...);
}

template <class F>
void bind_family(py::module_& m, const char* name) {
  static const auto fields = F::Params::fields();
  bind_filter<F>(m, name, fields,
                 std::make_index_sequence<std::tuple_size_v<std::decay_t<decltype(fields)>>>());
}

}  // namespace

void bind_filters(py::module_& m) {
  py::class_<FilterHandle>(m, "Filter", "A filter family with its parameters.")
      .def_property_readonly("name", [](const FilterHandle& f) { return f.filter->name(); })
      .def_property_readonly("params", [](const FilterHandle& f) { return from_params(f.filter->params()); })
      .def_property_readonly(
          "signal_names", [](const FilterHandle& f) { return f.filter->signal_names(); },
          "Names of the signals that a run can keep.")
      .def_property_readonly(
          "detail_names", [](const FilterHandle& f) { return f.filter->detail_names(); },
          "Names of the lists (sets, gains) that a run can keep.")
      .def("__repr__", [](const FilterHandle& f) {
        return f.filter->name() + py::repr(from_params(f.filter->params())).cast<std::string>();
      });
  bind_family<Saturation>(m, "Saturation");
  bind_family<ScalarGain>(m, "ScalarGain");
  bind_family<Lfre>(m, "Lfre");
  bind_family<Rdkf>(m, "Rdkf");
  bind_family<Dkf>(m, "Dkf");
  bind_family<Structural>(m, "Structural");
  bind_family<PartialSharing>(m, "PartialSharing");
  bind_family<Platoon>(m, "Platoon");
  bind_family<PlatoonBaseline>(m, "PlatoonBaseline");

  m.def(
      "lfre_parents",
      [](const FilterHandle& f, const Model& model, const Network& network) {
        return Lfre::design(parse_params<Lfre::Params>("lfre", f.filter->params()), model, network).parents;
      },
      py::arg("filter"), py::arg("model"), py::arg("network"), "Parents of every agent in an Lfre filter.");
  m.def(
      "make_filter",
      [](const std::string& name, const py::dict& params) {
        return FilterHandle{make_filter(name, to_params(params))};
      },
      py::arg("name"), py::arg("params"),
      "The filter `name`; unknown names are refused with the nearest one.");
  m.def(
      "filter_infos",
      [] {
        py::list all;
        for (const FamilyInfo& family : families()) {
          py::dict one;
          one["name"] = family.name;
          one["title"] = family.title;
          one["source"] = family.source;
          one["params"] = from_infos(family.params);
          all.append(one);
        }
        return all;
      },
      "All families with the description of their parameters.");
  m.def(
      "check",
      [](const FilterHandle& f, const Model& model, const Network& network, double seconds) {
        const Check check = within_budget(seconds, [&] { return f.filter->check(model, network); });
        py::list conditions;
        for (const auto& c : check.conditions)
          conditions.append(py::dict(py::arg("name") = c.name, py::arg("value") = c.value,
                                     py::arg("needed") = c.needed, py::arg("holds") = c.holds,
                                     py::arg("meaning") = c.meaning, py::arg("required") = c.required));
        py::list quantities;
        for (const auto& q : check.quantities)
          quantities.append(
              py::dict(py::arg("name") = q.name, py::arg("value") = q.value, py::arg("meaning") = q.meaning));
        return py::make_tuple(conditions, quantities);
      },
      py::arg("filter"), py::arg("model"), py::arg("network"), py::arg("seconds") = kInfinity,
      "Conditions and quantities of the family's theorems, as two lists of dicts. Searches end after "
      "`seconds` with a\n"
      "certified interval; a computation without partial results raises InvalidInput then. Ctrl-C ends it, "
      "too.");
}
