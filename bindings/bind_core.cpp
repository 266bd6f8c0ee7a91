// SPDX-License-Identifier: Apache-2.0
// Errors, parameters, and what Model and Network need of each other.
#include "bindings.hpp"
#include "convert.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/split_outputs.hpp"
#include "time_limit.hpp"

using namespace garrison;

namespace {

py::object value_to_python(const ParamValue& value) {
  return std::visit([](const auto& v) -> py::object { return py::cast(v); }, value);
}

void bind_budget(py::module_& m) {
  py::class_<TimeLimit, std::shared_ptr<TimeLimit>>(
      m, "budget",
      numpydoc(
          R"(`with budget(seconds) as b:` is the time of everything computed in the block. Searches end with what they
have proved; what has no partial result raises InvalidInput. Ctrl-C ends both.

seconds : float | > 0; inf = no limit.
! InvalidInput | Not a number above 0.)")
          .c_str())
      .def(py::init<double>(), py::arg("seconds") = kInfinity)
      .def("__enter__",
           [](const std::shared_ptr<TimeLimit>& self) {
             self->enter();
             return self;
           })
      .def(
          "__exit__",
          [](TimeLimit& self, const py::object&, const py::object&, const py::object&) { self.leave(); },
          py::arg("type"), py::arg("value"), py::arg("traceback"))
      .def_property_readonly("over", &TimeLimit::over, "The time is up, or Ctrl-C was pressed.");
}

ParamValue numbers(const std::string& which, py::handle given) {
  const auto all = convert::vector(which, given);
  return std::vector<double>(all.data(), all.data() + all.size());
}

}  // namespace

ParamMap to_params(const std::string& owner, const py::dict& given) {
  ParamMap params;
  for (const auto& [key, value] : given) {
    const auto name = convert::words(owner, key);
    const std::string which = owner + "." + name;
    if (value.is_none()) continue;
    if (py::isinstance<py::bool_>(value))
      params[name] = value.cast<bool>();
    else if (py::isinstance<py::str>(value))
      params[name] = convert::words(which, value);
    else if (py::isinstance<py::int_>(value))
      params[name] = convert::large(which, value);
    else if (!convert::scalar(value))
      params[name] = numbers(which, value);
    else if (PyIndex_Check(value.ptr()))
      params[name] = convert::large(which, value);
    else
      params[name] = convert::number(which, value);
  }
  return params;
}

py::dict from_params(const ParamMap& params) {
  py::dict all;
  for (const auto& [name, value] : params) all[py::str(name)] = value_to_python(value);
  return all;
}

std::string class_name(std::string_view name) {
  std::string camel;
  bool upper = true;
  for (const char c : name) {
    if (c != '_') camel += upper ? static_cast<char>(std::toupper(c)) : c;
    upper = c == '_';
  }
  return camel;
}

py::dict changed_params(const ParamMap& params, const std::vector<ParamInfo>& infos) {
  py::dict all;
  for (const ParamInfo& info : infos) {
    const ParamValue& value = params.at(info.name);
    const auto* number = std::get_if<double>(&value);
    const auto* initial = std::get_if<double>(&info.initial);
    const bool absent = number && initial && std::isnan(*number) && std::isnan(*initial);
    if (!absent && (info.required || value != info.initial)) all[py::str(info.name)] = value_to_python(value);
  }
  return all;
}

py::list from_infos(const std::vector<ParamInfo>& infos) {
  py::list all;
  for (const ParamInfo& info : infos) {
    py::dict one;
    one["name"] = info.name;
    one["symbol"] = info.symbol;
    one["unit"] = info.unit;
    one["doc"] = info.doc;
    one["default"] = value_to_python(info.initial);
    one["required"] = info.required;
    one["least"] = info.least;
    one["most"] = info.most;
    one["open"] = info.open;
    one["choices"] = info.choices;
    all.append(one);
  }
  return all;
}

std::string described(const ParamInfo& info) {
  constexpr const char* types[] = {"bool", "int", "float", "str", "sequence of float"};
  std::string words = info.name + " : " + types[info.initial.index()] + (info.required ? "" : ", optional") +
                      " | " + info.doc;
  if (!info.unit.empty()) words += " [" + info.unit + "]";
  if (std::isfinite(info.least)) words += (info.open ? ", > " : ", >= ") + text(info.least);
  if (std::isfinite(info.most)) words += ", <= " + text(info.most);
  std::string choices;
  for (const std::string& choice : info.choices) choices += (choices.empty() ? "" : ", ") + choice;
  return words + (choices.empty() ? "" : "; one of: " + choices);
}

void bind_core(py::module_& m) {
  auto& error = py::register_exception<Error>(m, "Error");
  error.doc() = "What garrison refuses, and cannot do; catch this one for all.";
  py::register_exception<InvalidInput>(m, "InvalidInput", py::make_tuple(error, py::handle(PyExc_ValueError)))
      .doc() =
      "Something that was given does not fit: which, what was got, what was expected. A ValueError, too.";
  py::register_exception<DesignInfeasible>(m, "DesignInfeasible",
                                           py::make_tuple(error, py::handle(PyExc_ValueError)))
      .doc() =
      "No gains exist, or none were found, for what was asked: why, and what to change. A ValueError, too.";
  py::register_exception<IoError>(m, "IoError", py::make_tuple(error, py::handle(PyExc_OSError))).doc() =
      "A file cannot be read or written: which, and why. An OSError, too.";

  bind_budget(m);
  bind_model(m);
  bind_network(m);
  m.def(
      "split_outputs",
      [](const Model& model, const Network& network) {
        auto split = split_outputs(model, network);
        return py::make_tuple(std::move(split.model), std::move(split.network), std::move(split.owner));
      },
      py::arg("model"), py::arg("network"),
      numpydoc(
          R"(The same plant with an agent per output: an agent with m outputs becomes m agents that hear each other.

model : Model | Agents with any number of outputs.
network : Network | Of the same agents.
< (Model, Network, list of int) | The model and network of the single outputs, and per new agent the one
  that it came from.
! InvalidInput | Model and network have another number of agents.)")
          .c_str());
  m.def(
      "nearest_name",
      [](const std::string& unknown, const std::vector<std::string>& known) {
        return nearest_name(unknown, known);
      },
      py::arg("unknown"), py::arg("known"), "The known name closest to `unknown`, or an empty text.");
}
