// SPDX-License-Identifier: Apache-2.0
// Networks from what Python has: pairs, graphs and adjacency matrices.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <unordered_map>
#include <vector>

#include "garrison/core/network.hpp"

namespace networks {

namespace py = pybind11;
using garrison::Network;
using Names = std::vector<std::string>;

/// The number of an agent from its number or name.
class Numbering {
 public:
  explicit Numbering(const Names& names);
  int operator()(const std::string& which, py::handle given) const;

 private:
  const Names& names_;
  std::unordered_map<std::string, int> of_;
};

/// Pairs of numbers or names, a networkx graph, or an adjacency matrix; agents and names may be None.
Network make_network(const py::object& source, const py::object& agents, bool directed,
                     const py::object& given_names);
/// An adjacency matrix, dense or sparse: entry (i, j) says that i hears j. Explicit zeros are no links, and
/// the diagonal says nothing (an agent always knows itself).
Network from_adjacency(const py::object& given, bool directed, Names names);

}  // namespace networks
