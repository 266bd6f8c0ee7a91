// SPDX-License-Identifier: Apache-2.0
// What the service manager is told (sd_notify(3)), without its library; what ends a program; what the kernel
// says of the clock.
#pragma once

#include <csignal>
#include <string>

#include "garrison/node/bytes.hpp"

namespace garrison::node {

/// "READY=1", "STATUS=...", "WATCHDOG=1", "STOPPING=1"; nothing where nobody asks.
void notify(const std::string& line) noexcept;
/// SIGTERM and SIGINT: what ends a program.
sigset_t ending_signals() noexcept;
/// How often the watchdog wants to hear: half of what it waits; 0 = never.
Micros watchdog_pause() noexcept;

Instant now() noexcept;
/// Whether the kernel holds the clock for synchronised.
bool clock_synchronised() noexcept;

}  // namespace garrison::node
