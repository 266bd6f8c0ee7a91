// SPDX-License-Identifier: Apache-2.0
// Numbers of each agent, where those of ghosts come from their ranks.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "partition/region.hpp"

namespace garrison::partition {

/// All ranks together. `region` and `exchange` must outlive it. Threads: one at a time.
template <class Number>
class GhostNumbers {
 public:
  /// `width` numbers of each agent.
  GhostNumbers(const Region& region, Exchange& exchange, std::size_t width = 1)
      : region_(region),
        exchange_(exchange),
        width_(width),
        out_(width * region.packed.size()),
        in_(width * region.arrival.size()) {
    exchange_.connect(region_.routes);
  }
  /// `at(place)`: the first number of each place; those of own agents that others hear are sent, those of
  /// ghosts written.
  template <class At>
  void fetch_by(const At& at) {
    for (std::size_t k = 0; k < region_.packed.size(); ++k)
      std::copy_n(at(region_.packed[k]), width_, out_.data() + k * width_);
    exchange_.begin(reinterpret_cast<const std::byte*>(out_.data()), reinterpret_cast<std::byte*>(in_.data()),
                    width_ * sizeof(Number));
    exchange_.finish();
    for (std::size_t k = 0; k < region_.arrival.size(); ++k)
      std::copy_n(in_.data() + k * width_, width_, at(region_.arrival[k]));
  }
  /// `here`: a number at each place.
  void fetch(std::span<Number> here) {
    fetch_by([&](int place) { return here.data() + place; });
  }

 private:
  const Region& region_;
  Exchange& exchange_;
  std::size_t width_;
  std::vector<Number> out_;
  std::vector<Number> in_;
};

}  // namespace garrison::partition
