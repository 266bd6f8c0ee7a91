// SPDX-License-Identifier: Apache-2.0
// One Python class per filter family, its constructor derived from the fields of Params.
#include <tuple>

#include "bindings.hpp"
#include "budget.hpp"
#include "garrison/filters/families.hpp"
#include "kept.hpp"

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

template <class F>
HandleOf<F> handle(const ParamMap& params) {
  HandleOf<F> made;
  made.filter = make_filter(std::string(F::name), params);
  return made;
}

template <class F, class... P, class... T, std::size_t... I>
void bind_filter(py::module_& m, [[maybe_unused]] const std::tuple<Field<P, T>...>& fields,
                 std::index_sequence<I...>) {
  const static std::string name = class_name(F::name);
  const static std::string doc = class_doc<F>();
  py::class_<HandleOf<F>, FilterHandle> bound(m, name.c_str(), doc.c_str());
  const auto make = [](T... given) {
    typename F::Params p;
    [[maybe_unused]] const auto all = F::Params::fields();
    ((p.*(std::get<I>(all).member) = std::move(given)), ...);
    return handle<F>(values(p));
  };
  if constexpr (sizeof...(T) == 0)
    bound.def(py::init(make));
  else
    bound.def(py::init(make), py::kw_only(),
              (py::arg(std::get<I>(fields).info.name.c_str()) =
                   typename F::Params{}.*(std::get<I>(fields).member))...);
  keep(
      bound, [](const HandleOf<F>& f) { return from_params(f.filter->params()); },
      [](const py::dict& params) { return handle<F>(to_params(std::string(F::name), params)); });
}

template <class F>
void bind_family(py::module_& m) {
  static const auto fields = F::Params::fields();
  bind_filter<F>(m, fields, std::make_index_sequence<std::tuple_size_v<std::decay_t<decltype(fields)>>>());
}

/// A filter as an object of its family's class.
std::unique_ptr<FilterHandle> named_filter(const std::string& name, const py::dict& params) {
  std::unique_ptr<FilterHandle> made;
  Families::each([&]<class F> {
    if (name == F::name) made = std::make_unique<HandleOf<F>>(handle<F>(to_params(name, params)));
  });
  if (!made) make_filter(name, {});  // refuses, with the nearest name
  return made;
}

std::string code(const FilterHandle& f) {
  const std::string name = f.filter->name();
  for (const FamilyInfo& family : families())
    if (family.name == name)
      return as_code("garrison.filters." + class_name(name),
                     changed_params(f.filter->params(), family.params));
  return name;
}

}  // namespace

void bind_filters(py::module_& m) {
  py::class_<FilterHandle> filter(m, "Filter", "A filter family with its parameters. Immutable.");
  filter.def_property_readonly("name", [](const FilterHandle& f) { return f.filter->name(); })
      .def_property_readonly("params", [](const FilterHandle& f) { return from_params(f.filter->params()); })
      .def_property_readonly(
          "signal_names", [](const FilterHandle& f) { return f.filter->signal_names(); },
          "Names of the signals that a run can keep.")
      .def_property_readonly(
          "detail_names", [](const FilterHandle& f) { return f.filter->detail_names(); },
          "Names of the lists (sets, gains) that a run can keep.")
      .def("__repr__", &code);
  compare<FilterHandle>(
      filter, [](const FilterHandle& a, const FilterHandle& b) { return code(a) == code(b); },
      [](const FilterHandle& f) { return py::str(code(f)); });
  auto classes = m.def_submodule("filters", "One class per filter family.");
  Families::each([&]<class F> { bind_family<F>(classes); });

  m.def(
      "lfre_parents",
      [](const FilterHandle& f, const Model& model, const Network& network) {
        require_same_size(model, network);
        return Lfre::design(params_of<Lfre>(f), model, network).parents;
      },
      py::arg("filter"), py::arg("model"), py::arg("network"), "Parents of every agent in an Lfre filter.");
  m.def("make_filter", &named_filter, py::arg("name"), py::arg("params") = py::dict(),
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
      [](const Model& model, const Network& network, const FilterHandle& f, double seconds) {
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
      py::arg("model"), py::arg("network"), py::arg("filter"), py::arg("seconds") = kInfinity,
      "Conditions and quantities of the family's theorems, as two lists of dicts. Searches end after "
      "`seconds` with a\n"
      "certified interval; a computation without partial results raises InvalidInput then. Ctrl-C ends it, "
      "too.");
}
