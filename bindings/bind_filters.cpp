// SPDX-License-Identifier: Apache-2.0
// One Python class per filter family, its constructor derived from the fields of Params.
#include <tuple>

#include "bindings.hpp"
#include "budget.hpp"
#include "garrison/filters/families.hpp"
#include "kept.hpp"
#include "own_family.hpp"
#include "own_filter.hpp"

using namespace garrison;

namespace {

template <class F>
std::string class_doc() {
  std::string doc = std::string(F::title) + ".\nSource: " + std::string(F::source) + "\n\n";
  for (const ParamInfo& info : describe<typename F::Params>()) doc += described(info) + "\n";
  return numpydoc(doc + "! InvalidInput | A parameter is out of range.");
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

py::dict params_shown(const FilterHandle& f) {
  return own::is_own(*f.filter) ? own::attributes_of(*f.filter) : from_params(f.filter->params());
}

/// What equal filters have in common: a class of one's own is the one that is found by its module and name.
py::tuple identity(const FilterHandle& f) {
  if (!own::is_own(*f.filter)) return py::make_tuple(f.filter->name(), params_shown(f));
  const auto type = py::type::of(own::object_of(*f.filter));
  return py::make_tuple(type.attr("__module__"), type.attr("__qualname__"), params_shown(f));
}

std::string code(const FilterHandle& f) {
  const std::string name = f.filter->name();
  if (own::is_own(*f.filter)) return as_code(name, own::attributes_of(*f.filter));
  for (const FamilyInfo& family : families())
    if (family.name == name)
      return as_code("garrison.filters." + class_name(name),
                     changed_params(f.filter->params(), family.params));
  return name;
}

}  // namespace

py::object filter_object(const AnyFilter& filter) {
  if (own::is_own(filter)) return own::object_of(filter);
  return py::cast(named_filter(filter.name(), from_params(filter.params())));
}

namespace {

constexpr const char* kFilterDoc =
    R"(A filter: a family of garrison.filters with its parameters, or a class of your own derived from this one.

A filter of your own has these methods, called in every sample for every agent; it runs in simulate and replay with
the same links, attacks, records and reports as every family. It is single-threaded, and slow: Python runs
at every agent, sample and round. `agent` is a garrison.AgentInfo, `state` is the agent's own object and may be
changed in place, a message is a dict of named arrays, inbox a dict: sender -> message (lost ones are not in it).

  sense(agent, state, y, t) -> message     once per sample; y (outputs,), nan = missing
  fuse(agent, state, inbox, round) -> message   `rounds` times per sample; what the last one returns is not sent

and optionally:

  rounds = 1                               rounds per sample (attribute, or set in __init__)
  signals = ("name", ...)                  numbers of `report` that a run can keep; names that a file can hold
  layout(model) -> {"estimate": n}         fields of a message and how many numbers each has (the default)
  design(model, network) -> gains          once; agents find it as agent.gains
  start(agent, x0) -> state                an object or dict with "estimate", (n,); default: just that
  report(agent, state) -> dict             bound, statistic, threshold, verdict (garrison.Verdict or its name), accused
                                           (list of agents), and the signals; what is left out does not exist
  rejoin(agent, state, inbox, t)           for an estimate that is not finite; default: median of "estimate" of the inbox
  expected(agent, state) -> (outputs,)     what it predicts to measure next; default C A estimate
  alarm_level(agent, state) -> number      deviation from that which it tolerates; default inf

A message of None sends nothing. Attributes set in __init__ (after super().__init__()) are the parameters: they stand
in the repr, in pickles and in saved runs, which hold no functions and no objects of other classes. What a method
raises comes back with its traceback and a note that names the agent and the sample.)";

}  // namespace

void bind_filters(py::module_& m) {
  py::class_<own::AgentInfo>(m, "AgentInfo", "What one agent of a filter of your own knows of itself.")
      .def_readonly("id", &own::AgentInfo::id, "Its number, 0..agents-1.")
      .def_readonly("agents", &own::AgentInfo::agents, "Agents of the whole network.")
      .def_readonly("name", &own::AgentInfo::name, "Its name in the network, or nothing.")
      .def_readonly("A", &own::AgentInfo::A, "Of the plant, (n, n).")
      .def_readonly("C", &own::AgentInfo::C, "Its own rows, (outputs, n).")
      .def_property_readonly(
          "process_covariance",
          [](const own::AgentInfo& a) { return a.Q.size() == 0 ? py::object(py::none()) : py::cast(a.Q); },
          "Of the step to this sample, (n, n); None: not known.")
      .def_property_readonly(
          "measurement_variance",
          [](const own::AgentInfo& a) {
            return a.R.size() == 0 && a.C.rows() > 0 ? py::object(py::none()) : py::cast(a.R);
          },
          "Variances of its outputs in this sample, (outputs,); None: not known.")
      .def_readonly("neighbours", &own::AgentInfo::neighbours, "Agents that it hears.")
      .def_readonly("gains", &own::AgentInfo::gains, "What design() returned.")
      .def("__repr__", [](const own::AgentInfo& a) { return "<AgentInfo " + std::to_string(a.id) + ">"; });

  py::class_<FilterHandle> filter(m, "Filter", kFilterDoc);
  const auto make_own = [] {
    auto made = std::make_unique<FilterHandle>();
    made->filter = own::filter_of(made.get());
    return made;
  };
  filter.def(py::init(make_own))
      .def(py::pickle(
          [](const FilterHandle& f) { return params_shown(f); },
          [make_own](const py::dict& attributes) { return std::make_pair(make_own(), attributes); }))
      .def_property_readonly(
          "name", [](const FilterHandle& f) { return f.filter->name(); }, "As in `garrison list`.")
      .def_property_readonly("params", &params_shown, "Parameters by name, those with defaults too.")
      .def_property_readonly(
          "own", [](const FilterHandle& f) { return own::is_own(*f.filter); },
          "Written in Python: a class derived from garrison.Filter.")
      .def_property_readonly(
          "signal_names", [](const FilterHandle& f) { return f.filter->signal_names(); },
          "Names of the signals that a run can keep.")
      .def_property_readonly(
          "detail_names", [](const FilterHandle& f) { return f.filter->detail_names(); },
          "Names of the lists (sets, gains) that a run can keep.")
      .def("__repr__", &code);
  compare_arguments<FilterHandle>(filter, &identity);
  auto classes = m.def_submodule("filters", "One class per filter family.");
  Families::each([&]<class F> { bind_family<F>(classes); });

  m.def(
      "lfre_parents",
      [](const Model& model, const Network& network, const FilterHandle& f) {
        require_same_size(model, network);
        return Lfre::design(params_of<Lfre>(f), model, network).parents;
      },
      py::arg("model"), py::arg("network"), py::arg("filter"), "Parents of every agent in an Lfre filter.");
  m.def("make_filter", &named_filter, py::arg("name"), py::arg("params") = py::dict(),
        numpydoc(R"(The filter of this name; unknown names are refused with the nearest one.

name : str | As in `garrison list`.
params : dict | Parameters by name; the rest have their defaults.
< Filter | An object of the family's class.
! InvalidInput | An unknown name, or a parameter that is unknown or out of range.)")
            .c_str());
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
      [](const Model& model, const Network& network, const FilterHandle& f, double seconds,
         const py::object& progress) {
        const Check check = within_budget(seconds, [&] { return f.filter->check(model, network); },
                                          {progress, "the conditions of " + std::string(f.filter->name())});
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
      py::arg("progress") = py::none(),
      "Conditions and quantities of the family's theorems, as two lists of dicts. Searches end after "
      "`seconds` with a\n"
      "certified interval; a computation without partial results raises InvalidInput then. Ctrl-C ends it, "
      "too. progress(what, seconds) is called about once a second.");
}
