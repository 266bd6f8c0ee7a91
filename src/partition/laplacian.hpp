// SPDX-License-Identifier: Apache-2.0
// Products with the Laplacian of a network that is spread over ranks.
#pragma once

#include <span>
#include <vector>

#include "partition/ghost_numbers.hpp"

namespace garrison::partition {

/// One number per own agent, by place. All ranks together. `region` and `exchange` must outlive it.
/// Threads: one at a time.
class Laplacian {
 public:
  Laplacian(const Region& region, Exchange& exchange);
  /// out = L v. The sum of every agent goes by the public ids of its neighbours: the same bits on any ranks.
  void apply(std::span<const double> v, std::span<double> out);
  /// Largest sum of the degrees of two neighbours: no eigenvalue is above (Anderson and Morley, 1985).
  double bound();

 private:
  void fetch(std::span<const double> v);

  const Region& region_;
  Exchange& exchange_;
  std::vector<double> here_;  // at every place
  GhostNumbers<double> ghosts_;
};

}  // namespace garrison::partition
