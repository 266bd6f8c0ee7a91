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
/// How urgent a line is, as the journal counts (sd-daemon(3)).
enum class Priority { error = 3, warning = 4, notice = 5 };
/// A line about the node on standard error; with its priority where the journal reads it.
void say(Priority priority, const std::string& what);
/// SIGTERM and SIGINT: what ends a program.
sigset_t ending_signals() noexcept;
/// Those, and SIGHUP, which lets a node read its files anew.
sigset_t node_signals() noexcept;
/// How often the watchdog wants to hear: half of what it waits; 0 = never.
Micros watchdog_pause() noexcept;

Instant now() noexcept;
/// Whether the kernel holds the clock for synchronised.
bool clock_synchronised() noexcept;

}  // namespace garrison::node
