// SPDX-License-Identifier: Apache-2.0
// What the agents of a large network see, asked for some of them at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/model.hpp"

namespace garrison::partition {

/// The plant, and sensors that are given one by one or drawn.
struct Sensors {
  Matrix A;
  std::vector<Matrix> C;   ///< of every agent; empty: one row of unit length each, in a random direction
  std::uint64_t seed = 0;  ///< of these
  double process_bound = kNaN;
  double measurement_bound = kNaN;     ///< of every output; NaN = not known
  Matrix process_covariance = {};      ///< empty = not known
  double measurement_variance = kNaN;  ///< of every output; NaN = not known

  /// The model of the agents `ids`. @throws InvalidInput as Model does
  Model model(std::span<const int> ids) const;

 private:
  Matrix rows(int id) const;
};

}  // namespace garrison::partition
