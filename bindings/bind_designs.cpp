// SPDX-License-Identifier: Apache-2.0
// Designs, their files, and the logs of agents made from them.
#include <tuple>

#include "agents.hpp"
#include "budget.hpp"
#include "bytes.hpp"
#include "garrison/node/log.hpp"
#include "own_filter.hpp"

using namespace garrison;

namespace {

constexpr const char* kSpreads[] = {"local", "flooded", "direct"};

std::optional<certificate::Wanted> wanted_of(const std::string& name, double failure, int attacked,
                                             const std::pair<double, double>& levels, bool memory) {
  if (name == "none") return std::nullopt;
  certificate::Wanted wanted;
  wanted.failure = failure;
  wanted.attacked = attacked;
  std::tie(wanted.z1, wanted.z2) = levels;
  wanted.memory = memory;
  const auto* const found = std::find(std::begin(kSpreads), std::end(kSpreads), name);
  if (found == std::end(kSpreads)) {
    std::vector<std::string> known{"none"};
    known.insert(known.end(), std::begin(kSpreads), std::end(kSpreads));
    refuse_unknown("certificate", name, known);
  }
  wanted.spread = static_cast<certificate::Spread>(found - kSpreads);
  return wanted;
}

/// The prepared filter with what its runs are to certify.
std::shared_ptr<Prepared> certifying(std::shared_ptr<const Prepared> prepared,
                                     const std::optional<certificate::Wanted>& wanted) {
  if (wanted) prepared = certified(*prepared, *wanted);
  return std::const_pointer_cast<Prepared>(prepared);
}

void bind_log(py::module_& m) {
  m.def(
      "replay_log",
      [](const py::object& log) {
        const node::LogReplay r = node::replay_log(from_python(log, "log"));
        py::dict out;
        out["agent"] = r.agent;
        out["family"] = r.family;
        out["calls"] = r.calls;
        out["estimates"] = r.estimates;
        out["differ"] = r.wrong;
        out["first"] = r.first;
        out["last"] = r.last;
        out["ended"] = r.ended;
        return out;
      },
      py::arg("log"),
      "Do again what the log of a node (bytes of an MCAP file) says. Returns agent, family, calls, estimates "
      "(compared),\n"
      "differ (estimates that differ in a bit, and calls that were refused), first and last sample, ended "
      "(the "
      "node was\n"
      "stopped, not killed). Raises InvalidInput for anything but a log.");
}

}  // namespace

void bind_designs(py::module_& m) {
  bind_log(m);
  py::class_<Prepared, std::shared_ptr<Prepared>>(m, "Design", "A filter designed for one model and network.")
      .def(py::init([](const Model& model, const Network& network, const FilterHandle& filter,
                       const std::string& certificate, double failure, int attacked,
                       const std::pair<double, double>& levels, bool memory, const py::object& progress) {
             const auto wanted = wanted_of(certificate, failure, attacked, levels, memory);
             return within_budget(kInfinity,
                                  [&] { return certifying(filter.filter->prepare(model, network), wanted); },
                                  {progress, "the design of " + std::string(filter.filter->name())});
           }),
           py::arg("model"), py::arg("network"), py::arg("filter"), py::arg("certificate") = "none",
           py::arg("failure") = 1e-6, py::arg("attacked") = 0, py::arg("levels") = std::pair(0.0, 0.0),
           py::arg("memory") = false, py::arg("progress") = py::none())
      .def_static(
          "from_gains",
          [](const Model& model, const Network& network, const FilterHandle& filter, const py::object& gains,
             const std::string& certificate, double failure, int attacked,
             const std::pair<double, double>& levels, bool memory) {
            const auto prepared = own::with_gains(*filter.filter, model, network, gains);
            const auto wanted = wanted_of(certificate, failure, attacked, levels, memory);
            return within_budget(kInfinity, [&] { return certifying(prepared, wanted); });
          },
          py::arg("model"), py::arg("network"), py::arg("filter"), py::arg("gains"),
          py::arg("certificate") = "none", py::arg("failure") = 1e-6, py::arg("attacked") = 0,
          py::arg("levels") = std::pair(0.0, 0.0), py::arg("memory") = false,
          "The design of a filter written in Python, from what its `design` returned before.")
      .def_property_readonly(
          "gains", [](const Prepared& p) { return own::gains_of(p); },
          "What `design` of a filter written in Python returned; None of a family's.")
      .def_property_readonly(
          "certificate",
          [](const Prepared& p) -> py::object {
            const auto plan = p.certificate();
            if (plan == nullptr) return py::none();
            const auto& wanted = plan->wanted;
            py::dict found(py::arg("certificate") = kSpreads[static_cast<std::size_t>(wanted.spread)],
                           py::arg("failure") = wanted.failure, py::arg("attacked") = wanted.attacked);
            if (wanted.z1 > 0.0) found["levels"] = std::pair(wanted.z1, wanted.z2);
            if (wanted.memory) found["memory"] = true;
            return found;
          },
          "What its runs certify (certificate, failure, attacked, levels and memory if given); None = "
          "nothing but "
          "the family's own "
          "bound.")
      .def_property_readonly("model", &Prepared::model)
      .def_property_readonly("network", &Prepared::network)
      .def_property_readonly("filter", [](const Prepared& p) { return filter_object(p.filter()); })
      .def_property_readonly("outline", &Prepared::gains_outline, "What the gains consist of, a line each.")
      .def(
          "agent", [](const std::shared_ptr<Prepared>& p, int id) { return agent_from(p, id); },
          py::arg("id"))
      .def(
          "part", [](const Prepared& p, int id) { return to_python(write_part(p, id)); }, py::arg("id"),
          "What agent `id` needs of the design, as bytes.")
      .def("to_bytes", [](const Prepared& p) { return to_python(write_design(p)); })
      .def_static(
          "from_bytes",
          [](const py::object& data) {
            return std::const_pointer_cast<Prepared>(read_design(from_python(data, "design file")));
          },
          py::arg("data"));
  m.def(
      "design_summary",
      [](const py::object& data) {
        const DesignSummary s = summary_of(from_python(data, "design file"));
        py::dict d;
        d["agent"] = s.part ? py::object(py::int_(s.agent)) : py::object(py::none());
        d["garrison"] = s.garrison;
        d["filter"] = s.filter;
        d["params"] = from_params(s.params);
        d["agents"] = s.agents;
        d["states"] = s.states;
        d["bytes"] = s.bytes;
        d["hash"] = hex(s.digest);
        return d;
      },
      py::arg("data"),
      "What a design file says of itself: filter, params, agents, states, bytes, hash, agent.");
}
