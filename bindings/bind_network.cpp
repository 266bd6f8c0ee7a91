// SPDX-License-Identifier: Apache-2.0
// Who hears whom.
#include "bindings.hpp"
#include "convert.hpp"
#include "garrison/core/network.hpp"
#include "kept.hpp"
#include "networks.hpp"

using namespace garrison;

namespace {

using networks::Names;
using networks::Numbering;

/// What `make_network` makes an equal one from.
py::dict arguments(const Network& network) {
  py::dict all(py::arg("edges") = network.edges(), py::arg("agents") = network.agents());
  if (network.directed()) all["directed"] = true;
  if (!network.names().empty()) all["names"] = network.names();
  return all;
}

Network network_from(const py::dict& given) {
  const bool named = given.contains("names");
  return networks::make_network(given["edges"], given["agents"], given.contains("directed"),
                                named ? py::object(given["names"]) : py::object(py::none()));
}

int index_of(const Network& network, const py::object& agent) {
  const int i = Numbering(network.names())("agent", agent);
  if (i < 0 || i >= network.agents())
    refuse("agent", std::to_string(i), "0.." + std::to_string(network.agents() - 1));
  return i;
}

template <class Class>
void bind_generators(Class& network) {
  network.def_static("ring", &Network::ring, py::arg("agents"), "i hears i - 1 and i + 1, around.")
      .def_static("path", &Network::path, py::arg("agents"), "i hears i - 1 and i + 1, from end to end.")
      .def_static("band", &Network::band, py::arg("agents"), py::arg("range"),
                  "i and j hear each other when |i - j| <= range.")
      .def_static("star", &Network::star, py::arg("agents"),
                  "Agent 0 and each of the others hear each other.")
      .def_static("complete", &Network::complete, py::arg("agents"), "Everybody hears everybody.")
      .def_static("grid", &Network::grid, py::arg("rows"), py::arg("columns"),
                  "rows x columns agents, row by row; neighbours in a row or column hear each other.")
      .def_static(
          "random_geometric",
          [](int agents, double radius, std::uint64_t seed) {
            return Network::random_geometric(agents, radius, seed);
          },
          py::arg("agents"), py::arg("radius"), py::arg("seed") = 0,
          "Points uniform in the unit square, edges below `radius`; it need not be connected (see "
          "`connected`).")
      .def_static("erdos_renyi", &Network::erdos_renyi, py::arg("agents"), py::arg("probability"),
                  py::arg("seed") = 0,
                  "Every pair is a link with this probability; it need not be connected (see `connected`).");
}

template <class Class>
void bind_matrices(Class& network) {
  network
      .def(
          "laplacian_spectrum",
          [](const Network& net) {
            const auto spectrum = net.laplacian_spectrum();
            return std::pair(spectrum.lambda2, spectrum.lambda_max);
          },
          "(lambda_2, lambda_max) of the Laplacian; undirected networks only.")
      .def("laplacian", &Network::laplacian,
           "(N, N): how many an agent hears on the diagonal, -1 for each of them.")
      .def("laplacian_weights", &Network::laplacian_weights, py::arg("step"), "I - step * Laplacian")
      .def("metropolis_weights", &Network::metropolis_weights,
           "Doubly stochastic (N, N) weights; undirected only.")
      .def("max_degree_weights", &Network::max_degree_weights, "I - Laplacian / (1 + largest degree)");
}

}  // namespace

void bind_network(py::module_& m) {
  py::class_<Network> network(m, "Network",
                              R"(Who hears whom. Immutable.

Parameters
----------
edges : sequence of pairs, networkx graph, or square matrix
    (sender, receiver) pairs of numbers or names, a graph, or an adjacency matrix (sparse, or dense with more than two
    rows; see from_adjacency). Pairs given twice count once.
agents : int, optional
    Needed when the last ones have no edge.
directed : bool
    A pair is one way; else both ways.
names : names, optional
    One per agent. Of a graph, labels 0..N-1 are the numbers of the agents; other whole numbers are sorted, other labels
    keep their order, and the labels become the names.

Raises
------
InvalidInput
    A self-loop, a weight, an unknown name, or an index out of range.
)");
  network
      .def(py::init(&networks::make_network), py::arg("edges"), py::arg("agents") = py::none(),
           py::arg("directed") = false, py::arg("names") = py::none())
      .def_static(
          "from_adjacency",
          [](const py::object& matrix, bool directed, const py::object& names) {
            return networks::from_adjacency(matrix, directed,
                                            names.is_none() ? Names() : convert::names("names", names));
          },
          py::arg("matrix"), py::arg("directed") = false, py::arg("names") = py::none(),
          "From a square matrix of zeros and ones, dense or sparse: entry (i, j) says that i hears j. "
          "Explicit\n"
          "zeros are no links; the diagonal is ignored. Names of a DataFrame's columns become the agents'.\n"
          "Raises InvalidInput when it is not square, not symmetric (unless directed) or holds another "
          "number.")
      .def_property_readonly("agents", &Network::agents, "How many, N.")
      .def_property_readonly("names", &Network::names, "One per agent; empty where none were given.")
      .def_property_readonly("directed", &Network::directed, "Whether a pair of edges is one way.")
      .def_property_readonly("edges", &Network::edges,
                             "Each link once: (smaller, larger) number, or (sender, receiver) when directed.")
      .def_property_readonly("connected", &Network::connected,
                             "Everybody can reach everybody (directed: along the links).")
      .def("index", &index_of, py::arg("agent"), "The number of the agent with this name (or number).")
      .def(
          "neighbours",
          [](const Network& net, const py::object& agent) {
            const auto heard = net.neighbours(index_of(net, agent));
            return std::vector<int>(heard.begin(), heard.end());
          },
          py::arg("agent"), "Sorted ids of the agents that `agent` (a number or name) hears.")
      .def("__repr__", [](const Network& net) { return as_code("garrison.Network", arguments(net)); })
      .def("__str__", [](const Network& net) {
        return std::string(net.directed() ? "Directed network" : "Network") + " of " +
               std::to_string(net.agents()) + " agents, " + std::to_string(net.edges().size()) + " edges";
      });
  bind_generators(network);
  bind_matrices(network);
  keep(network, arguments, network_from);
  compare<Network>(
      network, [](const Network& a, const Network& b) { return a == b; },
      [](const Network& net) {
        return py::make_tuple(
            net.agents(), net.directed(),
            py::bytes(reinterpret_cast<const char*>(net.lists().data()), net.lists().size_bytes()));
      });
}
