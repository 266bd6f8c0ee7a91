// SPDX-License-Identifier: Apache-2.0
// One Python function per attack, its arguments derived from the description of its parameters.
#include "bindings.hpp"
#include "convert.hpp"
#include "kept.hpp"
#include "own_attack.hpp"

using namespace garrison;

namespace {

using Phases = std::vector<std::pair<std::int64_t, std::vector<int>>>;

Schedule schedule_of(const Phases& given, std::optional<std::int64_t> stop, double probability) {
  std::vector<Schedule::Phase> phases;
  for (const auto& [start, agents] : given) phases.push_back({start, agents});
  return Schedule(std::move(phases), stop.value_or(Schedule::kForever), probability);
}

AnyAttack make(const std::string& name, const Phases& schedule, std::optional<std::int64_t> stop,
               double probability, const py::dict& params) {
  return make_attack(name, schedule_of(schedule, stop, probability), to_params(name, params));
}

py::dict params_shown(const AnyAttack& a) {
  return own::is_own(a) ? py::dict(py::arg("function") = own::function_of(a)) : from_params(a.params);
}

/// The arguments of `make`.
py::dict arguments(const AnyAttack& a) {
  Phases phases;
  for (const auto& phase : a.schedule().phases()) phases.emplace_back(phase.start, phase.agents);
  const std::int64_t stop = a.schedule().stop();
  return py::dict(
      py::arg("name") = a.name, py::arg("schedule") = phases,
      py::arg("stop") = stop == Schedule::kForever ? py::object(py::none()) : py::object(py::int_(stop)),
      py::arg("probability") = a.schedule().probability(), py::arg("params") = params_shown(a));
}

AnyAttack attack_from(const py::dict& given) {
  if (const auto params = given["params"].cast<py::dict>(); params.contains("function"))
    return own::attack(
        given["name"].cast<std::string>(),
        schedule_of(given["schedule"].cast<Phases>(), given["stop"].cast<std::optional<std::int64_t>>(),
                    given["probability"].cast<double>()),
        params["function"]);
  return make(given["name"].cast<std::string>(), given["schedule"].cast<Phases>(),
              given["stop"].cast<std::optional<std::int64_t>>(), given["probability"].cast<double>(),
              given["params"].cast<py::dict>());
}

const AttackInfo& info_of(const std::string& name) {
  std::vector<std::string> known;
  for (const AttackInfo& info : attack_infos()) {
    if (info.name == name) return info;
    known.push_back(info.name);
  }
  refuse_unknown("attack", name, known);
}

std::string code(const AnyAttack& a) {
  py::dict all;
  const auto& phases = a.schedule().phases();
  if (phases.size() == 1) all["agents"] = phases.front().agents;
  for (const auto& [name, value] :
       own::is_own(a) ? params_shown(a) : changed_params(a.params, info_of(a.name).params))
    all[name] = value;
  if (phases.size() > 1) all["schedule"] = arguments(a)["schedule"];
  if (phases.size() == 1 && phases.front().start != 1) all["start"] = phases.front().start;
  if (a.schedule().stop() != Schedule::kForever) all["stop"] = a.schedule().stop();
  if (a.schedule().probability() != 1.0) all["probability"] = a.schedule().probability();
  return as_code("garrison.attacks." + (own::is_own(a) ? a.name : class_name(a.name)), all);
}

/// A call of garrison.attacks.<Name>: agents or schedule, and the attack's own parameters.
AnyAttack call(const std::string& name, const py::object& agents, const py::dict& given) {
  const auto take = [&](const char* key) {
    return given.contains(key) ? given.attr("pop")(key) : py::object(py::none());
  };
  const py::object schedule = take("schedule");
  const py::object start = take("start");
  const py::object stop = take("stop");
  const py::object probability = take("probability");
  if (agents.is_none() == schedule.is_none())
    refuse("attack " + name, agents.is_none() ? "neither agents nor schedule" : "both agents and schedule",
           "exactly one of them");
  Phases phases;
  if (schedule.is_none())
    phases.emplace_back(start.is_none() ? 1 : convert::large(name + ".start", start),
                        agents.cast<std::vector<int>>());
  else
    phases = schedule.cast<Phases>();
  if (!schedule.is_none() && !start.is_none())
    refuse("attack " + name, "start and schedule", "one of them", "every phase of a schedule has its start");
  return make(name, phases,
              stop.is_none() ? std::nullopt : std::optional(convert::large(name + ".stop", stop)),
              probability.is_none() ? 1.0 : convert::number(name + ".probability", probability), given);
}

/// "value: float", as bindings of C++ functions write it: the guard and the stubs read it.
std::string parameter(const ParamInfo& info) {
  const char* types[] = {"bool", "typing.SupportsInt | typing.SupportsIndex",
                         "typing.SupportsFloat | typing.SupportsIndex", "str",
                         "collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]"};
  const bool number_as_text = std::holds_alternative<std::string>(info.initial) && info.choices.empty();
  std::string words = info.name + ": " + (number_as_text ? "typing.Any" : types[info.initial.index()]);
  if (!info.required) words += " = " + py::repr(from_params({{"", info.initial}})[""]).cast<std::string>();
  return words;
}

std::string documentation(const AttackInfo& info) {
  const std::string whole = "typing.SupportsInt | typing.SupportsIndex";
  const std::string many = "collections.abc.Sequence[" + whole + "]";
  std::string doc = class_name(info.name) + "(agents: " + many + " | None = None, *";
  for (const ParamInfo& p : info.params) doc += ", " + parameter(p);
  doc += ", start: " + whole + " | None = None, stop: " + whole +
         " | None = None, schedule: collections.abc.Sequence[tuple[" + whole + ", " + many +
         "]] | None = None, probability: typing.SupportsFloat | typing.SupportsIndex = 1.0) -> "
         "garrison._core.Attack\n\n";
  std::string body = info.doc + " (" + info.target + " attack).\n\n" +
                     "agents : sequence of int, optional | Ids that are attacked from `start` on; or give "
                     "`schedule`.\n";
  for (const ParamInfo& p : info.params) body += described(p) + "\n";
  body +=
      R"(start : int, optional | First sample that is attacked; below 1 is as 1; default 1.
stop : int, optional | First sample that is not attacked any more; default: never.
schedule : sequence of (start, agents), optional | Phases in order of time, instead of agents and start.
probability : float | Chance that an agent is attacked at a sample, 0..1.
< Attack
! InvalidInput | A number out of range, or both or neither of agents and schedule.)";
  doc += numpydoc(body);
  return doc;
}

void bind_functions(py::module_& m) {
  auto all = m.def_submodule("attacks", "One function per attack.");
  py::options plain;
  plain.disable_function_signatures();  // `documentation` writes the real one
  for (const AttackInfo& info : attack_infos()) {
    const std::string name = info.name;
    all.def(
        class_name(name).c_str(),
        [name](const py::object& agents, const py::kwargs& given) { return call(name, agents, given); },
        py::arg("agents") = py::none(), documentation(info).c_str());
  }
}

}  // namespace

void bind_attacks(py::module_& m) {
  py::class_<AnyAttack> attack(
      m, "Attack", "An attack with its schedule; made by the functions of garrison.attacks. Immutable.");
  attack.def_readonly("name", &AnyAttack::name, "As in `garrison list`.")
      .def_property_readonly(
          "target", [](const AnyAttack& a) { return a.message ? "message" : "measurement"; },
          "What it changes: \"measurement\" or \"message\".")
      .def_property_readonly("params", &params_shown, "Parameters by name, those with defaults too.")
      .def_property_readonly(
          "own", [](const AnyAttack& a) { return own::is_own(a); }, "Its lies come from a Python function.")
      .def_property_readonly(
          "agents", [](const AnyAttack& a) { return a.schedule().everyone(); },
          "Every agent that is attacked at some time.")
      .def_property_readonly(
          "start", [](const AnyAttack& a) { return a.schedule().first(); },
          "First sample that may be attacked.")
      .def_property_readonly(
          "stop", [](const AnyAttack& a) { return py::object(arguments(a)["stop"]); },
          "First sample that is not attacked any more; None = never.")
      .def_property_readonly(
          "schedule", [](const AnyAttack& a) { return py::list(arguments(a)["schedule"]); },
          "(start, agents) phases.")
      .def_property_readonly(
          "probability", [](const AnyAttack& a) { return a.schedule().probability(); },
          "Chance per sample that it acts, 0..1.")
      .def("__repr__", &code);
  keep(attack, arguments, attack_from);
  compare_arguments<AnyAttack>(attack, arguments);
  bind_functions(m);
  m.def(
      "custom_attack",
      [](const std::string& name, const py::object& function, const Phases& schedule,
         std::optional<std::int64_t> stop, double probability) {
        return own::attack(name, schedule_of(schedule, stop, probability), function);
      },
      py::arg("name"), py::arg("function"), py::arg("schedule"), py::arg("stop") = py::none(),
      py::arg("probability") = 1.0, "An attack by a Python function; use garrison.attacks.custom.");
  m.def("make_attack", &make, py::arg("name"), py::arg("schedule"), py::arg("stop") = py::none(),
        py::arg("probability") = 1.0, py::arg("params") = py::dict(),
        "The attack `name`. schedule: (start, agents) phases in order of time.");
  m.def(
      "attack_infos",
      [] {
        py::list all;
        for (const AttackInfo& info : attack_infos()) {
          py::dict one;
          one["name"] = info.name;
          one["target"] = info.target;
          one["doc"] = info.doc;
          one["params"] = from_infos(info.params);
          all.append(one);
        }
        return all;
      },
      "All attacks with the description of their parameters.");
}
