// SPDX-License-Identifier: Apache-2.0
// The scenario of a huge network: the keys of `garrison run` that make sense there, and generators.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "garrison/core/params.hpp"
#include "garrison/drivers/simulate.hpp"
#include "mpi/memory.hpp"
#include "partition/ground.hpp"
#include "partition/sensors.hpp"

namespace garrison::mpi {

/// What is written of every kept sample.
enum class Kept { estimates, summary };

struct Scenario {
  std::string path;
  std::uint64_t fingerprint = 0;    ///< of the file's bytes, and of the files that it names
  std::vector<std::string> inputs;  ///< paths of those
  std::unique_ptr<partition::Ground> ground;
  partition::Sensors sensors;
  std::string family;
  ParamMap params;
  PlantOptions plant;
  RunOptions run;
  std::string method = "auto";  ///< of the partition: auto, metis, coordinates, blocks
  Kept kept = Kept::summary;
  int every = 1;  ///< samples between those that are kept

  int agents() const { return ground->agents(); }
  int states() const { return static_cast<int>(sensors.A.rows()); }
};

/// `bytes`: what the network is going to take. @throws IoError, InvalidInput with file, line and key; where
/// that is too much memory, too
Scenario read_scenario(const std::string& path, const Bytes& bytes);

}  // namespace garrison::mpi
