// SPDX-License-Identifier: Apache-2.0
// Groups of n measurements that determine the state, and what they say of it along a direction. Internal to
// the search for contradictions.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "garrison/core/types.hpp"

namespace garrison::detail {

/// Sources that may lie, one bit each.
using Sources = std::uint64_t;

/// Measured rows, a column of `rows` each, with the bound of their noise and who may falsify them.
struct MeasuredRows {
  Matrix rows;                  ///< n x m
  Vector bound;                 ///< m numbers >= 0
  std::vector<Sources> source;  ///< one bit, or none of a measurement that nobody reaches
};

/// Bounds of one number.
struct Range {
  double lo = -kInfinity;
  double hi = kInfinity;
};

/// A direction d of the states in terms of each group: d = sum of weights times its rows.
struct Weighted {
  Matrix weights;               ///< groups x n
  Vector noise;                 ///< what the noise of the group can change d'x by
  std::vector<Sources> source;  ///< of the rows with a weight
  double length = 0.0;          ///< ||d||, or more where rounding was of larger numbers
  Vector room;                  ///< `noise`; infinite for groups with a source of `left_out`
  Sources left_out = 0;

  void leave_out(Sources some);
};

/// The measurements of one sample, group by group.
struct Readings {
  Matrix y;       ///< groups x n; zeros where one is missing
  Vector rounds;  ///< what rounding changes along a direction of length 1; infinite where one is missing
};

class RowBases {
 public:
  /// At most `most` groups: all there are, or a part drawn at random, the same one each time.
  RowBases(MeasuredRows measured, int most);

  bool empty() const { return members_.empty(); }
  Eigen::Index groups() const { return static_cast<Eigen::Index>(members_.size()); }
  void along(const Vector& direction, Weighted& out) const;
  void read(const double* y, Readings& out) const;
  /// Of d'x, from the groups that are not left out.
  static Range range(const Weighted& direction, const Readings& readings);
  /// The sources that the lower (upper) end of the range rests on.
  static Sources behind(const Weighted& direction, const Readings& readings, bool lower);

 private:
  bool add(const std::vector<int>& members);
  void all_of_them();
  void some(int most);

  MeasuredRows measured_;
  std::vector<std::vector<int>> members_;
  std::vector<Matrix> inverse_;   ///< of the rows of a group, n x n: weights = inverse' d
  std::vector<double> rounding_;  ///< per group
};

}  // namespace garrison::detail
