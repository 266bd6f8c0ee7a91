// SPDX-License-Identifier: Apache-2.0
// Numbers of the agents of a large network, asked for some of them at a time: no rank needs those of all.
#pragma once

#include <span>
#include <vector>

namespace garrison::partition {

/// Threads: constant once made; any number may share it.
class Column {
 public:
  virtual ~Column() = default;
  /// As many numbers of each of the agents `ids` (ascending), agent by agent. @throws Error
  virtual std::vector<double> of(std::span<const int> ids) const = 0;
};

}  // namespace garrison::partition
