// SPDX-License-Identifier: Apache-2.0
// A node from its files to its end: the loop in one thread, everything else in another one.
#pragma once

#include "garrison/node/node.hpp"
#include "node/daemon/station.hpp"

namespace garrison::node {

/// Before any thread: the signals that a node knows are waited for, not handled.
void block_signals();

/// Until a signal comes. print: a line of JSON a sample on standard output. tamper: a liar, for tests of a
/// network. @throws IoError, InvalidInput
void run_node(Station& station, bool print, Tamper* tamper = nullptr);

}  // namespace garrison::node
