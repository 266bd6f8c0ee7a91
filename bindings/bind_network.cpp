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
  network
      .def_static("ring", &Network::ring, py::arg("agents"),
                  numpydoc(R"(i hears i - 1 and i + 1, around.

agents : int | How many, N >= 1.
< Network
! InvalidInput | No agent, or more than memory holds.)")
                      .c_str())
      .def_static("path", &Network::path, py::arg("agents"),
                  numpydoc(R"(i hears i - 1 and i + 1, from end to end.

agents : int | How many, N >= 1.
< Network
! InvalidInput | No agent, or more than memory holds.)")
                      .c_str())
      .def_static("band", &Network::band, py::arg("agents"), py::arg("range"),
                  numpydoc(R"(i and j hear each other when |i - j| <= range.

agents : int | How many, N >= 1.
range : int | How many places away an agent hears, >= 1.
< Network
! InvalidInput | A number out of range, or more edges than memory holds.)")
                      .c_str())
      .def_static("star", &Network::star, py::arg("agents"),
                  numpydoc(R"(Agent 0 and each of the others hear each other.

agents : int | How many, N >= 1.
< Network
! InvalidInput | No agent, or more than memory holds.)")
                      .c_str())
      .def_static("complete", &Network::complete, py::arg("agents"),
                  numpydoc(R"(Everybody hears everybody.

agents : int | How many, N >= 1.
< Network
! InvalidInput | No agent, or more edges than memory holds.)")
                      .c_str())
      .def_static(
          "grid", &Network::grid, py::arg("rows"), py::arg("columns"),
          numpydoc(R"(rows x columns agents, row by row; neighbours in a row or column hear each other.

rows : int | How many, >= 1.
columns : int | How many, >= 1.
< Network
! InvalidInput | A number out of range, or more agents than memory holds.)")
              .c_str())
      .def_static(
          "random_geometric",
          [](int agents, double radius, std::uint64_t seed) {
            return Network::random_geometric(agents, radius, seed);
          },
          py::arg("agents"), py::arg("radius"), py::arg("seed") = 0,
          numpydoc(
              R"(Points uniform in the unit square, edges below `radius`; it need not be connected (see `connected`).

agents : int | How many, N >= 1.
radius : float | Agents closer than this hear each other, > 0; the square has sides of 1.
seed : int | Of the positions, >= 0; equal seeds give equal networks.
< Network
! InvalidInput | A number out of range.)")
              .c_str())
      .def_static(
          "erdos_renyi", &Network::erdos_renyi, py::arg("agents"), py::arg("probability"),
          py::arg("seed") = 0,
          numpydoc(R"(Every pair is a link with this probability; it need not be connected (see `connected`).

agents : int | How many, N >= 1.
probability : float | Of each link, 0..1.
seed : int | >= 0; equal seeds give equal networks.
< Network
! InvalidInput | A number out of range.)")
              .c_str());
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
      .def("laplacian_weights", &Network::laplacian_weights, py::arg("step"),
           numpydoc(R"(I - step * Laplacian

step : float | What an agent takes of each difference to a neighbour, > 0.
< (N, N) array | Weights; rows sum to 1.
! InvalidInput | A step that is not finite and > 0.)")
               .c_str())
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
          numpydoc(
              R"(From a square matrix of zeros and ones. Explicit zeros are no links; the diagonal is ignored.

matrix : (N, N) array, sparse matrix or DataFrame | Entry (i, j) says that i hears j. Names of a DataFrame's
  columns become the agents'.
directed : bool | Entries are one way; else the matrix is symmetric.
names : names, optional | One per agent.
< Network
! InvalidInput | Not square, not symmetric (unless directed), or another number.)")
              .c_str())
      .def_property_readonly("agents", &Network::agents, "How many, N.")
      .def_property_readonly("names", &Network::names, "One per agent; empty where none were given.")
      .def_property_readonly("directed", &Network::directed, "Whether a pair of edges is one way.")
      .def_property_readonly("edges", &Network::edges,
                             "Each link once: (smaller, larger) number, or (sender, receiver) when directed.")
      .def_property_readonly("connected", &Network::connected,
                             "Everybody can reach everybody (directed: along the links).")
      .def("index", &index_of, py::arg("agent"),
           numpydoc(R"(The number of the agent with this name (or number).

agent : str or int | A name of the network, or a number 0..N-1.
< int | 0..N-1.
! InvalidInput | There is no such agent.)")
               .c_str())
      .def(
          "neighbours",
          [](const Network& net, const py::object& agent) {
            const auto heard = net.neighbours(index_of(net, agent));
            return std::vector<int>(heard.begin(), heard.end());
          },
          py::arg("agent"),
          numpydoc(R"(The agents that one agent hears.

agent : str or int | A name of the network, or a number 0..N-1.
< list of int | Sorted.
! InvalidInput | There is no such agent.)")
              .c_str())
      .def("__repr__", [](const Network& net) { return as_code("garrison.Network", arguments(net)); })
      .def("__str__", [](const Network& net) {
        return std::string(net.directed() ? "Directed network" : "Network") + " of " +
               amount(net.agents(), "agent") + ", " + amount(net.edges().size(), "edge");
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
