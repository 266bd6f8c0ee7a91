// SPDX-License-Identifier: Apache-2.0
// What a node keeps between its lives: how often it has started, and its last snapshot.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "garrison/node/peer.hpp"

namespace garrison::node {

/// How often the node has started; 0 = never. @throws IoError, InvalidInput
std::uint64_t last_boot(const std::string& folder);
/// One more than last time, on the disk before it is returned. @throws IoError, InvalidInput
std::uint64_t next_boot(const std::string& folder);

/// The file "state": "GSTATE01", the run (Prologue), size u64, snapshot, BLAKE2b-128 of all before.
void write_state(const std::string& folder, const Prologue& run, Bytes snapshot);
std::vector<std::byte> state_bytes(const Prologue& run, Bytes snapshot);
/// The snapshot; nothing when there is none, when it is damaged or of another run.
std::optional<std::vector<std::byte>> read_state(const std::string& folder, const Prologue& run);
bool has_state(const std::string& folder);
std::optional<std::vector<std::byte>> snapshot_in(Bytes file, const Prologue& run);

}  // namespace garrison::node
