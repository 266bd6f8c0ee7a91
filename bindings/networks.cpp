// SPDX-License-Identifier: Apache-2.0
#include "networks.hpp"

#include <algorithm>
#include <limits>

#include "convert.hpp"
#include "garrison/core/params.hpp"

using namespace garrison;

namespace networks {

Numbering::Numbering(const Names& names) : names_(names) {
  for (std::size_t k = 0; k < names.size(); ++k) of_.emplace(names[k], static_cast<int>(k));
}

int Numbering::operator()(const std::string& which, py::handle given) const {
  if (!py::isinstance<py::str>(given)) return convert::small(which, given);
  const auto name = convert::words(which, given);
  if (names_.empty()) refuse(which, "\"" + name + "\"", "a number", "names need names=[..], one per agent");
  const auto found = of_.find(name);
  if (found == of_.end()) refuse_unknown(which, name, names_);
  return found->second;
}

namespace {

Network build(std::int64_t agents, const std::vector<Edge>& edges, bool directed, Names names) {
  require_memory("agents", std::to_string(agents), 8.0 * static_cast<double>(agents));
  if (agents > std::numeric_limits<int>::max())
    refuse("agents", std::to_string(agents), "at most " + std::to_string(std::numeric_limits<int>::max()));
  return {static_cast<int>(agents), edges, directed, std::move(names)};
}

constexpr const char* kSources = "(sender, receiver) pairs, a networkx graph or a sparse adjacency matrix";

/// Labels 0..N-1 keep their number; other whole numbers are sorted, other labels keep their order, and both
/// become names.
Network from_graph(const py::object& graph, const py::object& agents, Names names) {
  const py::list nodes(graph.attr("nodes")());
  const auto count = static_cast<std::int64_t>(nodes.size());
  bool whole = true;
  for (const auto& node : nodes) whole = whole && PyLong_CheckExact(node.ptr());
  bool own = whole;
  for (const auto& node : nodes) own = own && node >= py::int_(0) && node < py::int_(count);
  py::dict number;
  if (own) {
    for (const auto& node : nodes) number[node] = node;
  } else if (!names.empty()) {
    for (std::size_t k = 0; k < names.size(); ++k) number[py::str(names[k])] = k;
    for (const auto& node : nodes)
      if (!number.contains(node)) refuse_unknown("names", py::str(node).cast<std::string>(), names);
  } else {
    if (whole) nodes.attr("sort")();
    for (const auto& node : nodes) {
      number[node] = py::len(number);
      names.push_back(py::str(node).cast<std::string>());
    }
  }
  std::vector<Edge> edges;
  for (const auto& edge : graph.attr("edges")()) {
    const py::tuple pair(py::reinterpret_borrow<py::object>(edge));
    edges.emplace_back(number[pair[0]].cast<int>(), number[pair[1]].cast<int>());
  }
  const std::int64_t all = agents.is_none() ? std::max(count, static_cast<std::int64_t>(names.size()))
                                            : convert::small("agents", agents);
  return build(all, edges, graph.attr("is_directed")().cast<bool>(), std::move(names));
}

/// A square array of true and false: no list of edges.
bool matrix_of_flags(const py::object& given) {
  if (!py::hasattr(given, "dtype") || !py::hasattr(given, "ndim") || !py::hasattr(given, "shape"))
    return false;
  if (given.attr("dtype").attr("kind").cast<std::string>() != "b" || given.attr("ndim").cast<int>() != 2)
    return false;
  const py::tuple sides(given.attr("shape"));
  return sides[0].equal(sides[1]);
}

/// Two rows of two numbers that could be an adjacency matrix as well as two edges that mean something else.
bool ambiguous(const py::object& given, const py::list& items, bool directed) {
  if (items.size() != 2 || matrix_of_flags(given)) return false;
  for (const auto& item : items) {
    if (py::isinstance<py::tuple>(item) || !py::hasattr(item, "__len__") || py::len(item) != 2) return false;
    for (const auto& end : py::list(py::reinterpret_borrow<py::object>(item)))
      if (py::isinstance<py::str>(end)) return false;  // names of agents
  }
  const auto a = convert::array("edges", given, kSources);
  if (a.ndim() != 2) return false;
  if (a.at(0, 0) == 1.0 && a.at(1, 1) == 1.0 && a.at(0, 1) == 0.0 && a.at(1, 0) == 0.0) return true;
  if (a.at(0, 0) != 0.0 || a.at(1, 1) != 0.0) return false;
  return (directed || a.at(0, 1) == a.at(1, 0)) && !(a.at(0, 1) == 1.0 && a.at(1, 0) == 1.0);
}

/// (sender, receiver) from one item of a list of edges.
Edge edge_of(const std::string& which, py::handle item, const Numbering& number) {
  const std::string expected = "a pair (sender, receiver)";
  if (py::isinstance<py::str>(item) || py::isinstance<py::dict>(item) || !py::hasattr(item, "__len__") ||
      !py::hasattr(item, "__getitem__"))
    refuse(which, convert::shown(item), expected);
  const py::list ends(py::reinterpret_borrow<py::object>(item));
  if (ends.size() == 3)
    refuse(which, "3 values", expected, "a network has no weights; leave the third value out");
  if (ends.size() != 2) refuse(which, amount(ends.size(), "value"), expected);
  return {number(which + "[0]", ends[0]), number(which + "[1]", ends[1])};
}

/// A DataFrame of pandas.
bool table(const py::object& given) {
  return py::hasattr(given, "columns") && py::hasattr(given, "to_numpy") && py::hasattr(given, "index");
}

/// An adjacency table with its rows in the order of its columns, by their labels; rows that are numbered, not
/// labelled, stay as they are.
py::object aligned(const py::object& given) {
  const py::list columns(given.attr("columns"));
  const py::list rows(given.attr("index"));
  bool numbered = true;
  for (std::size_t k = 0; k < rows.size(); ++k)
    numbered = numbered && PyLong_Check(rows[k].ptr()) && py::int_(k).equal(rows[k]);
  if (numbered || rows.equal(columns)) return given;
  const py::set labels(columns);
  if (!labels.equal(py::set(rows)) || labels.size() != columns.size() || rows.size() != columns.size())
    refuse("adjacency.index", convert::shown(rows), "the same different labels as the columns have",
           "rows and columns are matched by name");
  return given.attr("loc")[columns];
}

/// A table of two columns that can be no adjacency matrix: senders and receivers.
bool edge_table(const py::object& given) {
  return table(given) && py::len(given.attr("columns")) == 2 && py::len(given) != 2;
}

/// Rows that begin with the name of an agent.
bool named_edges(const py::list& items) {
  if (items.size() == 0 || !py::hasattr(items[0], "__len__") || py::len(items[0]) < 2) return false;
  return py::isinstance<py::str>(py::list(py::reinterpret_borrow<py::object>(items[0]))[0]);
}

/// A square table of more than two rows is an adjacency matrix.
bool square(const py::list& items) {
  const auto N = items.size();
  if (N < 3) return false;
  for (const auto& item : items)
    if (py::isinstance<py::str>(item) || !py::hasattr(item, "__len__") || py::len(item) != N) return false;
  return true;
}

}  // namespace

Network from_adjacency(const py::object& source, bool directed, Names names) {
  const char* which = "adjacency";
  const py::object given = table(source) ? aligned(source) : source;
  if (names.empty() && table(given)) {
    const py::list columns(given.attr("columns"));
    if (columns.size() > 0 && py::isinstance<py::str>(columns[0]))
      names = convert::names("adjacency.columns", columns);
  }
  std::vector<std::pair<Edge, double>> entries;
  std::pair<std::int64_t, std::int64_t> shape;
  if (py::hasattr(given, "tocoo")) {
    const py::object coo = given.attr("tocoo")();
    const py::tuple sides = coo.attr("shape");
    if (sides.size() != 2) refuse(which, amount(sides.size(), "dimension"), "two");
    shape = {sides[0].cast<std::int64_t>(), sides[1].cast<std::int64_t>()};
    const auto rows = coo.attr("row").cast<std::vector<std::int64_t>>();
    const auto columns = coo.attr("col").cast<std::vector<std::int64_t>>();
    const auto values = convert::array(which, coo.attr("data"));
    for (std::size_t k = 0; k < rows.size(); ++k)
      entries.push_back({{static_cast<int>(rows[k]), static_cast<int>(columns[k])}, values.data()[k]});
  } else {
    const auto dense = convert::array(which, given, "a square matrix of zeros and ones");
    if (dense.ndim() != 2) refuse(which, convert::shown(dense), "a square matrix of zeros and ones");
    shape = {dense.shape(0), dense.shape(1)};
    for (py::ssize_t i = 0; i < dense.shape(0); ++i)
      for (py::ssize_t j = 0; j < dense.shape(1); ++j)
        if (dense.at(i, j) != 0.0)
          entries.push_back({{static_cast<int>(i), static_cast<int>(j)}, dense.at(i, j)});
  }
  if (shape.first != shape.second)
    refuse(which, std::to_string(shape.first) + " x " + std::to_string(shape.second), "a square matrix");
  std::vector<Edge> edges;
  for (const auto& [place, value] : entries) {
    const auto [i, j] = place;
    if (value == 0.0) continue;
    if (value != 1.0)
      refuse(which + ("[" + std::to_string(i)) + ", " + std::to_string(j) + "]", text(value), "0 or 1",
             "a network has no weights; pass matrix != 0");
    if (i == j) continue;  // an agent always knows itself
    edges.emplace_back(j, i);
  }
  Network network = build(shape.first, edges, directed, std::move(names));
  if (!directed && 2 * network.edges().size() != Network(network.agents(), edges, true).edges().size())
    refuse(which, "a matrix that is not symmetric", "a symmetric one",
           "directed=True makes a directed network");
  return network;
}

Network make_network(const py::object& source, const py::object& agents, bool directed,
                     const py::object& given_names) {
  Names names = given_names.is_none() ? Names() : convert::names("names", given_names);
  if (py::hasattr(source, "nodes") && py::hasattr(source, "edges") && py::hasattr(source, "is_directed"))
    return from_graph(source, agents, std::move(names));
  if (py::isinstance<py::str>(source) || py::isinstance<py::bytes>(source) ||
      py::isinstance<py::dict>(source) || convert::scalar(source))
    if (!py::hasattr(source, "tocoo"))
      refuse("edges", convert::shown(source), kSources,
             convert::scalar(source)
                 ? "the order is Network(edges, agents); Network.complete(agents), .ring, .path "
                   "and others need no edges"
                 : "");
  const bool sparse = py::hasattr(source, "tocoo");
  const py::list items = sparse          ? py::list()
                         : table(source) ? py::list(source.attr("to_numpy")())
                                         : py::list(source);
  const bool unclear = ambiguous(source, items, directed);
  const bool names_edges = !sparse && table(source) && named_edges(items);
  if (!unclear && !names_edges &&
      (sparse || (table(source) && !edge_table(source)) || matrix_of_flags(source) || square(items))) {
    Network network = from_adjacency(source, directed, std::move(names));
    const int count = agents.is_none() ? network.agents() : convert::small("agents", agents);
    if (count != network.agents())
      refuse("agents", std::to_string(count), std::to_string(network.agents()) + ", the size of the matrix");
    return network;
  }
  if (unclear)
    refuse("edges", "two rows that may be two edges or an adjacency matrix", "one of them",
           "use Network.from_adjacency(matrix), or tuples for edges");
  const Numbering number(names);
  std::vector<Edge> edges;
  std::int64_t count = static_cast<std::int64_t>(names.size());
  for (const auto& item : items) {
    edges.push_back(edge_of("edges[" + std::to_string(edges.size()) + "]", item, number));
    if (names.empty())
      count = std::max({count, std::int64_t{edges.back().first} + 1, std::int64_t{edges.back().second} + 1});
  }
  if (!agents.is_none()) count = convert::small("agents", agents);
  return build(count, edges, directed, std::move(names));
}

}  // namespace networks
