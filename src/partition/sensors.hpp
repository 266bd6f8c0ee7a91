// SPDX-License-Identifier: Apache-2.0
// What the agents of a large network see, asked for some of them at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "garrison/core/model.hpp"
#include "partition/column.hpp"

namespace garrison::partition {

/// The plant, and sensors that are given one by one, drawn, or read where they are asked for.
struct Sensors {
  Matrix A;
  std::vector<Matrix> C;   ///< of every agent; empty: one row of unit length each, in a random direction
  std::uint64_t seed = 0;  ///< of these
  double process_bound = kNaN;
  double measurement_bound = kNaN;                    ///< of every output; NaN = not known
  Matrix process_covariance = {};                     ///< empty = not known
  double measurement_variance = kNaN;                 ///< of every output; NaN = not known
  std::shared_ptr<const Column> rows_read = {};       ///< in place of C: one row of each agent
  std::shared_ptr<const Column> bounds_read = {};     ///< in place of measurement_bound: one of each agent
  std::shared_ptr<const Column> variances_read = {};  ///< in place of measurement_variance: one of each

  /// The model of the agents `ids`, ascending. @throws InvalidInput as Model does, Error as Column does
  Model model(std::span<const int> ids) const;

 private:
  std::vector<Matrix> rows(std::span<const int> ids) const;
  Matrix row(int id) const;
};

}  // namespace garrison::partition
