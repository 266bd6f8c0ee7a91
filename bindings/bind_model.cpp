// SPDX-License-Identifier: Apache-2.0
// The plant.
#include "bindings.hpp"
#include "convert.hpp"
#include "garrison/core/discretise.hpp"
#include "garrison/core/model.hpp"
#include "kept.hpp"

using namespace garrison;

namespace {

std::string at(const char* which, std::size_t k) {
  return std::string(which) + "[" + std::to_string(k) + "]";
}

/// The entries of a list, one per agent.
py::list per_agent(const std::string& which, const py::object& given, const std::string& expected) {
  const py::object plain = py::hasattr(given, "toarray") ? convert::array(which, given, expected)  // sparse
                           : py::hasattr(given, "to_numpy") ? given.attr("to_numpy")()             // a table
                                                            : given;
  const bool can = !convert::scalar(plain) && !py::isinstance<py::str>(plain) &&
                   !py::isinstance<py::bytes>(plain) && !py::isinstance<py::dict>(plain);
  if (!can) refuse(which, convert::shown(plain), expected);
  return convert::listed(which, plain, expected);
}

/// C: one matrix per agent, or one N x n array with a row per agent. A flat list of n numbers is one row.
std::vector<Matrix> rows_per_agent(const py::object& given, Eigen::Index n) {
  std::vector<Matrix> C;
  const std::string rows = "one row, or rows x " + std::to_string(n);
  for (const auto& one : per_agent("C", given, "one matrix of observation rows per agent")) {
    const std::string which = at("C", C.size());
    const auto array = convert::array(which, one, rows + " numbers");
    if (array.ndim() > 2 || (array.ndim() == 0 && n != 1))
      refuse(which, amount(array.ndim(), "dimension"), rows);
    if (array.size() == 0)
      C.emplace_back(0, n);
    else if (array.ndim() == 2)
      C.push_back(convert::eigen(array));
    else
      C.push_back(convert::eigen(array).transpose());
  }
  return C;
}

Vector bound_per_agent(const py::object& given, std::size_t agents) {
  if (given.is_none()) return {};
  const auto array = convert::array("measurement_bound", given, "a number, or one number per agent");
  if (array.ndim() > 1)
    refuse("measurement_bound", convert::shown(array), "a number, or one number per agent");
  if (array.ndim() == 0) return Vector::Constant(static_cast<Eigen::Index>(agents), *array.data());
  return Eigen::Map<const Vector>(array.data(), array.size());
}

/// A number (times the identity), one n x n matrix for all, or one per agent.
void set_process_covariance(Noise& noise, const py::object& given, Eigen::Index n) {
  const char* which = "process_covariance";
  const std::string expected = "a number, n x n numbers, or one n x n matrix per agent";
  const auto all = convert::array(which, given, expected);
  if (all.ndim() == 0) {
    noise.process_covariance = *all.data() * Matrix::Identity(n, n);
  } else if (all.ndim() == 2) {
    noise.process_covariance = convert::eigen(all);
  } else if (all.ndim() == 3) {
    for (const auto& one : py::list(all))
      noise.agent_process_covariance.push_back(
          convert::eigen(convert::Array(py::reinterpret_borrow<py::object>(one))));
  } else {
    refuse(which, convert::shown(all), expected);
  }
}

/// Refuses one matrix for the noises of all agents together.
void require_blocks(const char* which, const py::object& given, const std::vector<Matrix>& C) {
  py::ssize_t total = 0;
  for (const Matrix& rows : C) total += rows.rows();
  if (C.size() < 2 || !py::isinstance<py::array>(given)) return;
  const auto joint = py::reinterpret_borrow<py::array>(given);
  if (joint.ndim() != 2 || joint.shape(0) != total || joint.shape(1) != total) return;
  refuse(which, std::to_string(total) + " x " + std::to_string(total) + " numbers",
         amount(C.size(), "matrix", "matrices") + ", one per agent",
         "noises of different agents are independent: give the block of each agent, or numbers of the "
         "diagonal");
}

/// One entry for each agent: a matrix, or a number (times the identity), or the numbers of its diagonal.
std::vector<Matrix> measurement_covariances(const py::object& given, const std::vector<Matrix>& C) {
  const char* which = "measurement_covariance";
  std::vector<Matrix> all;
  if (convert::scalar(given)) {
    const double variance = convert::number(which, given);
    for (const Matrix& rows : C) all.push_back(variance * Matrix::Identity(rows.rows(), rows.rows()));
    return all;
  }
  require_blocks(which, given, C);
  for (const auto& one : per_agent(which, given, "a number, or one matrix per agent")) {
    const std::string name = at(which, all.size());
    const auto array = convert::array(name, one, "a number, or m x m numbers");
    if (array.ndim() > 2) refuse(name, convert::shown(array), "a number, or m x m numbers");
    const Eigen::Index m = all.size() < C.size() ? C[all.size()].rows() : 0;
    if (array.size() == 0)
      all.emplace_back(0, 0);
    else if (array.ndim() == 2)
      all.push_back(convert::eigen(array));
    else if (array.ndim() == 1)
      all.push_back(Eigen::Map<const Vector>(array.data(), array.size()).asDiagonal().toDenseMatrix());
    else
      all.push_back(*array.data() * Matrix::Identity(m, m));
  }
  return all;
}

std::vector<std::string> optional_names(const char* which, const py::object& given) {
  return given.is_none() ? std::vector<std::string>() : convert::names(which, given);
}

/// units: a dict from the name of a state or output to its unit, or one text for all states and named
/// outputs.
std::map<std::string, std::string> units_of(const py::object& given, const Labels& labels, Eigen::Index n) {
  std::map<std::string, std::string> units;
  if (given.is_none()) return units;
  if (py::isinstance<py::str>(given)) {
    const auto unit = convert::words("units", given);
    for (Eigen::Index k = 0; labels.states.empty() && k < n; ++k) units["x" + std::to_string(k + 1)] = unit;
    for (const auto& name : labels.states) units[name] = unit;
    for (const auto& name : labels.outputs) units[name] = unit;
    return units;
  }
  if (!py::isinstance<py::dict>(given))
    refuse("units", convert::shown(given), "a dict from names of states and outputs to units, or one unit");
  for (const auto& [name, unit] : py::reinterpret_borrow<py::dict>(given))
    units[convert::words("units", name)] = convert::words("units", unit);
  return units;
}

Model make_model(const py::object& A, const py::object& C, const py::object& process_bound,
                 const py::object& measurement_bound, const py::object& process_covariance,
                 const py::object& measurement_covariance, const py::object& states,
                 const py::object& outputs, const py::object& sources, const py::object& units,
                 const py::object& exposed, const py::object& B, const py::object& inputs) {
  const Matrix plant = convert::eigen(convert::matrix("A", A));
  std::vector<Matrix> rows = rows_per_agent(C, plant.cols());
  Noise noise;
  if (!process_bound.is_none()) noise.process_bound = convert::number("process_bound", process_bound);
  noise.measurement_bound = bound_per_agent(measurement_bound, rows.size());
  if (!process_covariance.is_none()) set_process_covariance(noise, process_covariance, plant.rows());
  if (!measurement_covariance.is_none())
    noise.measurement_covariance = measurement_covariances(measurement_covariance, rows);
  Labels labels{optional_names("states", states),
                optional_names("outputs", outputs),
                optional_names("sources", sources),
                {},
                optional_names("inputs", inputs)};
  labels.units = units_of(units, labels, plant.rows());
  std::vector<int> reach;
  if (!exposed.is_none())
    for (const auto& one : per_agent("exposed", exposed, "one whole number per agent"))
      reach.push_back(convert::small(at("exposed", reach.size()), one));
  Matrix driven;
  if (!B.is_none()) driven = convert::eigen(convert::matrix("B", B));
  return {plant, std::move(rows), std::move(noise), std::move(reach), std::move(labels), std::move(driven)};
}

/// The spectral density of continuous noise; a number times the identity, None = no noise.
Matrix intensity_of(const py::object& given, Eigen::Index n) {
  if (given.is_none()) return Matrix::Zero(n, n);
  if (convert::scalar(given)) return convert::number("process_intensity", given) * Matrix::Identity(n, n);
  return convert::eigen(convert::matrix("process_intensity", given));
}

Model make_from_continuous(const py::object& A, const py::object& C, double period,
                           const py::object& process_intensity, const py::object& process_bound,
                           const py::object& measurement_bound, const py::object& measurement_covariance,
                           const py::object& states, const py::object& outputs, const py::object& sources,
                           const py::object& units, const py::object& exposed, const py::object& B,
                           const py::object& inputs) {
  const Matrix F = convert::eigen(convert::matrix("A", A));
  const Discretised found = discretise(F, intensity_of(process_intensity, F.rows()), period);
  const py::object covariance =
      process_intensity.is_none() ? py::object(py::none()) : py::cast(found.covariance);
  const py::object held =
      B.is_none() ? B : py::cast(held_input(F, convert::eigen(convert::matrix("B", B)), period));
  return make_model(py::cast(found.A), C, process_bound, measurement_bound, covariance,
                    measurement_covariance, states, outputs, sources, units, exposed, held, inputs);
}

std::vector<Matrix> matrices(const Model& model) {
  std::vector<Matrix> all;
  for (int i = 0; i < model.agents(); ++i) all.push_back(model.C(i));
  return all;
}

/// What `make_model` makes an equal one from.
py::dict arguments(const Model& model) {
  py::dict all(py::arg("A") = model.A(), py::arg("C") = matrices(model));
  const Noise& noise = model.noise();
  const Labels& labels = model.labels();
  if (!std::isnan(noise.process_bound)) all["process_bound"] = noise.process_bound;
  if (noise.measurement_bound.size() != 0) all["measurement_bound"] = noise.measurement_bound;
  if (noise.process_covariance.size() != 0) all["process_covariance"] = noise.process_covariance;
  if (!noise.agent_process_covariance.empty()) all["process_covariance"] = noise.agent_process_covariance;
  if (!noise.measurement_covariance.empty()) all["measurement_covariance"] = noise.measurement_covariance;
  if (!labels.states.empty()) all["states"] = labels.states;
  if (!labels.outputs.empty()) all["outputs"] = labels.outputs;
  if (!labels.sources.empty()) all["sources"] = labels.sources;
  if (!labels.units.empty()) all["units"] = labels.units;
  if (model.inputs() > 0) all["B"] = model.B();
  if (!labels.inputs.empty()) all["inputs"] = labels.inputs;
  std::vector<int> exposed;
  bool everything = true;
  for (int i = 0; i < model.agents(); ++i) {
    exposed.push_back(model.exposed(i));
    everything = everything && model.exposed(i) == model.outputs(i);
  }
  if (!everything) all["exposed"] = exposed;
  return all;
}

Model model_from(const py::dict& given) {
  const auto get = [&](const char* name) {
    return given.contains(name) ? py::object(given[name]) : py::object(py::none());
  };
  return make_model(get("A"), get("C"), get("process_bound"), get("measurement_bound"),
                    get("process_covariance"), get("measurement_covariance"), get("states"), get("outputs"),
                    get("sources"), get("units"), get("exposed"), get("B"), get("inputs"));
}

}  // namespace

void bind_model(py::module_& m) {
  py::class_<Model> model(m, "Model",
                          R"(The plant x(t+1) = A x(t) + B u(t) + w(t), y_i(t) = C_i x(t) + v_i(t). Immutable.

Parameters
----------
A : (n, n) array
    Of the plant.
C : sequence of (m_i, n) arrays, or (N, n) array
    One per agent (m_i = 0: a relay), or rows.
process_bound : float, optional
    ||w|| <= it, >= 0; None or nan = not known.
measurement_bound : float or (N,) array, optional
    |v_i| <= it; one for all, or one per agent.
process_covariance : (n, n) array, float or (N, n, n) array, optional
    A number is times the identity; N of them where each agent takes another one for w (no noise is simulated from
    those).
measurement_covariance : float, or one (m_i, m_i) array or number per agent, optional
    Of v_i.
states : n names, optional
    Default x1, x2, ..
outputs : names, optional
    One per measurement of the whole network, agent by agent.
sources : names, optional
    Who can falsify each measurement; several outputs of one receiver have one source.
units : dict or str, optional
    From names of states and outputs to units, or one unit for all.
exposed : sequence of int, optional
    Per agent, how many of its first outputs an attacker can reach; default all.
B : (n, p) array, optional
    What known inputs u do to the state; runs then take `inputs`, one row u(t) per step. Default: no inputs.
inputs : p names, optional
    One per column of B.

Raises
------
InvalidInput
    Shapes or names do not fit, or a number is not finite.
)");
  model
      .def(py::init(&make_model), py::arg("A"), py::arg("C"), py::kw_only(),
           py::arg("process_bound") = py::none(), py::arg("measurement_bound") = py::none(),
           py::arg("process_covariance") = py::none(), py::arg("measurement_covariance") = py::none(),
           py::arg("states") = py::none(), py::arg("outputs") = py::none(), py::arg("sources") = py::none(),
           py::arg("units") = py::none(), py::arg("exposed") = py::none(), py::arg("B") = py::none(),
           py::arg("inputs") = py::none())
      .def_static(
          "from_continuous", &make_from_continuous, py::arg("A"), py::arg("C"), py::arg("period"),
          py::kw_only(), py::arg("process_intensity") = py::none(), py::arg("process_bound") = py::none(),
          py::arg("measurement_bound") = py::none(), py::arg("measurement_covariance") = py::none(),
          py::arg("states") = py::none(), py::arg("outputs") = py::none(), py::arg("sources") = py::none(),
          py::arg("units") = py::none(), py::arg("exposed") = py::none(), py::arg("B") = py::none(),
          py::arg("inputs") = py::none(),
          numpydoc(
              R"(The model of dx/dt = A x + B u + white noise, u held between samples, sampled exactly (C. F. Van Loan, IEEE
TAC 23 (3), 1978).

A : (n, n) array | Of the differential equation, per unit of time.
C : sequence of (m_i, n) arrays, or (N, n) array | As in Model.
period : float | Time between samples, > 0, in the unit of time of A.
process_intensity : (n, n) array or float, optional | Spectral density of the noise, state^2 per time; a
  number is times the identity. The model then has its process_covariance.
process_bound : float, optional | Of the noise from sample to sample, as in Model.
measurement_bound, measurement_covariance, states, outputs, sources, units, exposed : optional | As in
  Model.
B : (n, p) array, optional | What known inputs u do to dx/dt.
inputs : p names, optional | One per column of B.
< Model | From sample to sample.
! InvalidInput | As Model, or a period that is not > 0.)")
              .c_str())
      .def_property_readonly("A", &Model::A, "(n, n), of the plant.")
      .def_property_readonly("C", &matrices, "One (m_i, n) array per agent.")
      .def_property_readonly("B", &Model::B, "(n, p); no columns where there are no known inputs.")
      .def_property_readonly("inputs", &Model::inputs, "p, how many known inputs.")
      .def_property_readonly(
          "input_names", [](const Model& x) { return x.labels().inputs; },
          "One name per known input; empty where none were given.")
      .def_property_readonly("states", &Model::states, "n, how many states.")
      .def_property_readonly("agents", &Model::agents, "N, how many agents.")
      .def_property_readonly("outputs", &Model::total_outputs,
                             "Scalar measurements per sample of the whole network.")
      .def_property_readonly("state_names", &Model::state_names, "n names; x1, x2, .. where none were given.")
      .def_property_readonly(
          "output_names", [](const Model& x) { return x.labels().outputs; },
          "One name per measurement of the whole network; empty where none were given.")
      .def_property_readonly(
          "sources", [](const Model& x) { return x.labels().sources; },
          "Who can falsify each measurement; empty where none were given.")
      .def_property_readonly(
          "units", [](const Model& x) { return x.labels().units; }, "Unit by the name of a state or output.")
      .def_property_readonly(
          "process_bound", [](const Model& x) { return x.noise().process_bound; },
          "||w(t)|| is at most this; nan = not known.")
      .def_property_readonly(
          "measurement_bound", [](const Model& x) { return x.noise().measurement_bound; },
          "(N,): ||v_i(t)|| is at most this; empty = not known.")
      .def_property_readonly(
          "process_covariance",
          [](const Model& x) -> py::object {
            if (!x.noise().agent_process_covariance.empty())
              return py::cast(x.noise().agent_process_covariance);
            if (x.noise().process_covariance.size() == 0) return py::none();
            return py::cast(x.noise().process_covariance);
          },
          "(n, n), one (n, n) array per agent, or None = not known.")
      .def_property_readonly(
          "measurement_covariance",
          [](const Model& x) -> py::object {
            if (x.noise().measurement_covariance.empty()) return py::none();
            return py::cast(x.noise().measurement_covariance);
          },
          "One (m_i, m_i) array per agent, or None = not known.")
      .def("__repr__", [](const Model& x) { return as_code("garrison.Model", arguments(x)); })
      .def("__str__", [](const Model& x) {
        return "Model with " + amount(x.states(), "state") + ", " + amount(x.agents(), "agent") + ", " +
               amount(x.total_outputs(), "output");
      });
  keep(model, arguments, model_from);
  compare<Model>(
      model, [](const Model& a, const Model& b) { return a == b; },
      [](const Model& x) {
        const Matrix all = x.A().array() + 0.0;  // -0 equals 0
        return py::make_tuple(x.agents(), x.total_outputs(),
                              py::bytes(reinterpret_cast<const char*>(all.data()),
                                        sizeof(double) * static_cast<std::size_t>(all.size())));
      });
}
