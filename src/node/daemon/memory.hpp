// SPDX-License-Identifier: Apache-2.0
// What a node holds of the machine's memory once it runs.
#pragma once

namespace garrison::node {

/// Gives back the code that only the start needed, and locks what is used from then on, where that is
/// allowed: no page fault waits for a disk. To be called once everything has run.
void settle_memory() noexcept;

}  // namespace garrison::node
