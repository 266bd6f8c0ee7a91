// SPDX-License-Identifier: Apache-2.0
// Errors, Model, Network, parameters.
#include "bindings.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/split_outputs.hpp"

using namespace garrison;

namespace {

/// C: one matrix per agent, or one N x n array with a row per agent. A flat list of n numbers is one row.
std::vector<Matrix> rows_per_agent(const py::object& given, Eigen::Index n) {
  std::vector<Matrix> C;
  std::size_t i = 0;
  for (const auto& one : given) {
    const std::string which = "C[" + std::to_string(i++) + "]";
    const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(one);
    if (!array) {
      PyErr_Clear();
      refuse(which, "something that is not an array of numbers", "m x " + std::to_string(n) + " numbers");
    }
    if (array.ndim() > 2 || array.ndim() == 0)
      refuse(which, std::to_string(array.ndim()) + " dimensions", "one row, or rows x " + std::to_string(n));
    const auto rows = array.size() == 0 ? 0 : array.ndim() == 1 ? 1 : array.shape(0);
    const auto cols = array.size() == 0 ? n : array.shape(array.ndim() - 1);
    C.emplace_back(
        Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(array.data(), rows, cols));
  }
  return C;
}

Vector bound_per_agent(const py::object& given, std::size_t agents) {
  if (given.is_none()) return {};
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array || array.ndim() > 1) {
    PyErr_Clear();
    refuse("measurement_bound", "something else", "a number, or one number per agent");
  }
  if (array.ndim() == 0) return Vector::Constant(static_cast<Eigen::Index>(agents), *array.data());
  return Eigen::Map<const Vector>(array.data(), array.size());
}

/// One n x n matrix for all, or one per agent.
void set_process_covariance(Noise& noise, const py::object& given) {
  const auto all = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!all || all.ndim() < 2 || all.ndim() > 3) {
    PyErr_Clear();
    refuse("process_covariance", "something else", "n x n numbers, or one n x n matrix per agent");
  }
  using Rows = Eigen::Matrix<double, -1, -1, Eigen::RowMajor>;
  const auto rows = all.shape(all.ndim() - 2);
  const auto columns = all.shape(all.ndim() - 1);
  if (all.ndim() == 2) noise.process_covariance = Eigen::Map<const Rows>(all.data(), rows, columns);
  for (py::ssize_t i = 0; all.ndim() == 3 && i < all.shape(0); ++i)
    noise.agent_process_covariance.emplace_back(
        Eigen::Map<const Rows>(all.data() + i * rows * columns, rows, columns));
}

Model make_model(const Matrix& A, const py::object& C, double process_bound,
                 const py::object& measurement_bound, const py::object& process_covariance,
                 const std::optional<py::object>& measurement_covariance) {
  std::vector<Matrix> rows = rows_per_agent(C, A.cols());
  Noise noise;
  noise.process_bound = process_bound;
  noise.measurement_bound = bound_per_agent(measurement_bound, rows.size());
  if (!process_covariance.is_none()) set_process_covariance(noise, process_covariance);
  if (measurement_covariance) {
    for (const auto& one : *measurement_covariance) {
      const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(one);
      if (!array) throw py::error_already_set();
      const auto rows_of_it = array.ndim() == 2 ? array.shape(0) : array.size() == 0 ? 0 : 1;
      const auto columns = array.ndim() == 2 ? array.shape(1) : array.size() == 0 ? 0 : array.size();
      noise.measurement_covariance.emplace_back(
          Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(array.data(), rows_of_it,
                                                                           columns));
    }
  }
  return {A, std::move(rows), std::move(noise)};
}

/// Edge list, networkx graph, or sparse/dense adjacency matrix.
Network make_network(const py::object& source, std::optional<int> agents, bool directed) {
  std::vector<Edge> edges;
  int count = agents.value_or(0);
  if (py::hasattr(source, "nodes") && py::hasattr(source, "edges")) {
    py::dict number;
    for (const auto& node : source.attr("nodes")()) number[node] = py::len(number);
    for (const auto& edge : source.attr("edges")()) {
      const auto pair = edge.cast<py::tuple>();
      edges.emplace_back(number[pair[0]].cast<int>(), number[pair[1]].cast<int>());
    }
    directed = source.attr("is_directed")().cast<bool>();
    count = std::max(count, static_cast<int>(py::len(number)));
  } else if (py::hasattr(source, "tocoo")) {
    const py::object coo = source.attr("tocoo")();
    const auto rows = coo.attr("row").cast<std::vector<int>>();
    const auto columns = coo.attr("col").cast<std::vector<int>>();
    // Entry (i, j): i hears j.
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k] != columns[k]) edges.emplace_back(columns[k], rows[k]);
    count = std::max(count, coo.attr("shape").cast<std::pair<int, int>>().first);
  } else {
    for (const auto& item : source) {
      const auto pair = py::reinterpret_borrow<py::object>(item).cast<std::pair<int, int>>();
      edges.push_back(pair);
      if (!agents) count = std::max({count, pair.first + 1, pair.second + 1});
    }
  }
  return {count, edges, directed};
}

py::object value_to_python(const ParamValue& value) {
  return std::visit([](const auto& v) -> py::object { return py::cast(v); }, value);
}

}  // namespace

ParamMap to_params(const py::dict& given) {
  ParamMap params;
  for (const auto& [key, value] : given) {
    const auto name = key.cast<std::string>();
    if (value.is_none()) continue;
    if (py::isinstance<py::bool_>(value))
      params[name] = value.cast<bool>();
    else if (py::isinstance<py::int_>(value))
      params[name] = value.cast<std::int64_t>();
    else if (py::isinstance<py::str>(value))
      params[name] = value.cast<std::string>();
    else if (py::isinstance<py::float_>(value) || py::hasattr(value, "__float__"))
      params[name] = value.cast<double>();
    else if (py::isinstance<py::sequence>(value))
      params[name] = value.cast<std::vector<double>>();
    else
      refuse(name, py::repr(value).cast<std::string>(), "a number, a text, true, false or a list of numbers");
  }
  return params;
}

py::dict from_params(const ParamMap& params) {
  py::dict all;
  for (const auto& [name, value] : params) all[py::str(name)] = value_to_python(value);
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

void bind_core(py::module_& m) {
  auto& error = py::register_exception<Error>(m, "Error");
  py::register_exception<InvalidInput>(m, "InvalidInput",
                                       py::make_tuple(error, py::handle(PyExc_ValueError)));
  py::register_exception<DesignInfeasible>(m, "DesignInfeasible",
                                           py::make_tuple(error, py::handle(PyExc_ValueError)));
  py::register_exception<IoError>(m, "IoError", py::make_tuple(error, py::handle(PyExc_OSError)));

  py::class_<Model>(
      m, "Model",
      "The plant x(t+1) = A x(t) + w(t), y_i(t) = C_i x(t) + v_i(t). Immutable.\n\n"
      "A: (n, n). C: one (m_i, n) array per agent (m_i = 0: a relay), or an (N, n) array of rows.\n"
      "process_bound: ||w|| <= it, >= 0, nan = not known. measurement_bound: |v_i| <= it, a number or\n"
      "one per agent. Covariances: (n, n), or (N, n, n) where each agent takes another one for w (no noise "
      "is\n"
      "simulated from those), and one (m_i, m_i) array per agent.\n"
      "Raises InvalidInput when shapes do not fit or a number is not finite.")
      .def(py::init(&make_model), py::arg("A"), py::arg("C"), py::kw_only(), py::arg("process_bound") = kNaN,
           py::arg("measurement_bound") = py::none(), py::arg("process_covariance") = py::none(),
           py::arg("measurement_covariance") = py::none())
      .def_property_readonly("A", &Model::A, "(n, n)")
      .def_property_readonly(
          "C",
          [](const Model& model) {
            std::vector<Matrix> all;
            for (int i = 0; i < model.agents(); ++i) all.push_back(model.C(i));
            return all;
          },
          "One (m_i, n) array per agent.")
      .def_property_readonly("states", &Model::states, "n")
      .def_property_readonly("agents", &Model::agents, "N")
      .def_property_readonly("outputs", &Model::total_outputs,
                             "Scalar measurements per sample of the whole network.")
      .def_property_readonly("process_bound", [](const Model& model) { return model.noise().process_bound; })
      .def_property_readonly("measurement_bound",
                             [](const Model& model) { return model.noise().measurement_bound; })
      .def("__repr__", [](const Model& model) {
        return "Model(states=" + std::to_string(model.states()) +
               ", agents=" + std::to_string(model.agents()) +
               ", outputs=" + std::to_string(model.total_outputs()) + ")";
      });

  py::class_<Network>(
      m, "Network",
      "Who hears whom. Immutable.\n\nedges: (sender, receiver) pairs, a networkx graph, or a sparse\n"
      "matrix whose entry (i, j) says that i hears j. agents: needed when the last ones have no edge.\n"
      "Pairs given twice count once. Raises InvalidInput on a self-loop or an index out of range.")
      .def(py::init(&make_network), py::arg("edges"), py::arg("agents") = py::none(),
           py::arg("directed") = false)
      .def_property_readonly("agents", &Network::agents)
      .def_property_readonly("directed", &Network::directed)
      .def_property_readonly("edges", &Network::edges)
      .def_property_readonly("connected", &Network::connected)
      .def(
          "neighbours",
          [](const Network& net, int i) {
            if (i < 0 || i >= net.agents())
              refuse("agent", std::to_string(i), "0.." + std::to_string(net.agents() - 1));
            return std::vector<int>(net.neighbours(i).begin(), net.neighbours(i).end());
          },
          py::arg("agent"), "Sorted ids of the agents that `agent` hears.")
      .def(
          "laplacian_spectrum",
          [](const Network& net) {
            const auto spectrum = net.laplacian_spectrum();
            return std::pair(spectrum.lambda2, spectrum.lambda_max);
          },
          "(lambda_2, lambda_max) of the Laplacian; undirected networks only.")
      .def("laplacian", &Network::laplacian)
      .def("laplacian_weights", &Network::laplacian_weights, py::arg("step"), "I - step * Laplacian")
      .def("metropolis_weights", &Network::metropolis_weights,
           "Doubly stochastic (N, N) weights; undirected only.")
      .def("max_degree_weights", &Network::max_degree_weights, "I - Laplacian / (1 + largest degree)")
      .def_static("ring", &Network::ring, py::arg("agents"))
      .def_static("path", &Network::path, py::arg("agents"))
      .def_static("band", &Network::band, py::arg("agents"), py::arg("range"),
                  "i and j hear each other when |i - j| <= range.")
      .def_static("star", &Network::star, py::arg("agents"))
      .def_static("complete", &Network::complete, py::arg("agents"))
      .def_static("grid", &Network::grid, py::arg("rows"), py::arg("columns"))
      .def_static(
          "random_geometric",
          [](int agents, double radius, std::uint64_t seed) {
            return Network::random_geometric(agents, radius, seed);
          },
          py::arg("agents"), py::arg("radius"), py::arg("seed") = 0,
          "Points uniform in the unit square, edges below `radius`.")
      .def_static("erdos_renyi", &Network::erdos_renyi, py::arg("agents"), py::arg("probability"),
                  py::arg("seed") = 0)
      .def("__repr__", [](const Network& net) {
        return "Network(agents=" + std::to_string(net.agents()) +
               ", edges=" + std::to_string(net.edges().size()) + (net.directed() ? ", directed)" : ")");
      });
  m.def(
      "split_outputs",
      [](const Model& model, const Network& network) {
        auto split = split_outputs(model, network);
        return py::make_tuple(std::move(split.model), std::move(split.network), std::move(split.owner));
      },
      py::arg("model"), py::arg("network"),
      "(model, network, owner) with an agent per output: m agents that hear each other for one with m "
      "outputs.");
  m.def(
      "nearest_name",
      [](const std::string& unknown, const std::vector<std::string>& known) {
        return nearest_name(unknown, known);
      },
      py::arg("unknown"), py::arg("known"), "The known name closest to `unknown`, or an empty text.");
}
