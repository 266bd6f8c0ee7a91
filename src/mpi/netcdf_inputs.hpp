// SPDX-License-Identifier: Apache-2.0
// Networks and numbers of agents from netCDF files: a rank reads files in pieces and keeps what is of its own
// agents.
#pragma once

#include <memory>
#include <string>

#include "partition/column.hpp"
#include "partition/ground.hpp"

namespace garrison::mpi {

/// Which variable of which file.
struct NetcdfInput {
  std::string path;
  std::string variable;
};

/// The undirected network of the edges, a row of two agents each; an edge given twice counts once.
/// `checksum`: of the file. @throws IoError, InvalidInput, here and when agents are asked for
std::unique_ptr<partition::Ground> netcdf_network(const NetcdfInput& input, int agents,
                                                  std::uint64_t checksum);
/// A row of `width` numbers of each of `agents` agents; width 0: one number >= 0 of each. @throws IoError,
/// InvalidInput, also when a number is not finite
std::shared_ptr<const partition::Column> netcdf_column(const NetcdfInput& input, int agents, int width);

}  // namespace garrison::mpi
