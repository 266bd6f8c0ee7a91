// SPDX-License-Identifier: Apache-2.0
#include "bindings.hpp"

using namespace garrison;

void bind_attacks(py::module_& m) {
  py::class_<AnyAttack>(m, "Attack",
                        "An attack with its schedule; made by the functions of garrison.attacks.")
      .def_readonly("name", &AnyAttack::name)
      .def_property_readonly("target",
                             [](const AnyAttack& a) { return a.message ? "message" : "measurement"; })
      .def_property_readonly(
          "agents",
          [](const AnyAttack& a) {
            return (a.message ? a.message->schedule() : a.measurement->schedule()).everyone();
          },
          "Every agent that is attacked at some time.")
      .def_property_readonly(
          "start",
          [](const AnyAttack& a) {
            return (a.message ? a.message->schedule() : a.measurement->schedule()).first();
          },
          "First sample that may be attacked.")
      .def("__repr__", [](const AnyAttack& a) { return "Attack(" + a.name + ")"; });

  m.def(
      "make_attack",
      [](const std::string& name, const std::vector<std::pair<std::int64_t, std::vector<int>>>& schedule,
         std::optional<std::int64_t> stop, double probability, const py::dict& params) {
        std::vector<Schedule::Phase> phases;
        for (const auto& [start, agents] : schedule) phases.push_back({start, agents});
        return make_attack(name, Schedule(std::move(phases), stop.value_or(Schedule::kForever), probability),
                           to_params(params));
      },
      py::arg("name"), py::arg("schedule"), py::arg("stop"), py::arg("probability"), py::arg("params"),
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
