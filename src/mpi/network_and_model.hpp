// SPDX-License-Identifier: Apache-2.0
// The sections [network] and [model] of a scenario.
#pragma once

#include <memory>

#include "mpi/memory.hpp"
#include "mpi/named_files.hpp"
#include "partition/ground.hpp"
#include "partition/sensors.hpp"

namespace garrison::mpi {

/// `bytes`: what it is going to take. @throws InvalidInput with file, line and key; where that is too much
/// memory, too
std::unique_ptr<partition::Ground> read_ground(const node::Section& s, Inputs& inputs, const Bytes& bytes);

/// Of `agents` agents. @throws InvalidInput with file, line and key
partition::Sensors read_sensors(const node::Section& s, int agents, Inputs& inputs);

}  // namespace garrison::mpi
