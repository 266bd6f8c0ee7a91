// SPDX-License-Identifier: Apache-2.0
// One number of each agent, where those of ghosts come from their ranks.
#pragma once

#include <span>
#include <vector>

#include "partition/region.hpp"

namespace garrison::partition {

/// All ranks together. `region` and `exchange` must outlive it. Threads: one at a time.
template <class Number>
class GhostNumbers {
 public:
  GhostNumbers(const Region& region, Exchange& exchange)
      : region_(region), exchange_(exchange), out_(region.packed.size()), in_(region.arrival.size()) {
    exchange_.connect(region_.routes);
  }
  /// `here`: a number at each place; those of own agents that others hear are sent, those of ghosts written.
  void fetch(std::span<Number> here) {
    for (std::size_t k = 0; k < out_.size(); ++k) out_[k] = here[static_cast<std::size_t>(region_.packed[k])];
    exchange_.begin(reinterpret_cast<const std::byte*>(out_.data()), reinterpret_cast<std::byte*>(in_.data()),
                    sizeof(Number));
    exchange_.finish();
    for (std::size_t k = 0; k < in_.size(); ++k) here[static_cast<std::size_t>(region_.arrival[k])] = in_[k];
  }

 private:
  const Region& region_;
  Exchange& exchange_;
  std::vector<Number> out_;
  std::vector<Number> in_;
};

}  // namespace garrison::partition
