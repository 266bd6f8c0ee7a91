// SPDX-License-Identifier: Apache-2.0
#include "giant_record.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "garrison/core/error.hpp"
#include "median.hpp"

namespace garrison::detail {
namespace {

using Index = Eigen::Index;

/// Row of the largest deviation of a station.
Index largest(const MatrixRef& deviations, Index station) {
  Index row = 0;
  double size = -1.0;
  for (Index r = 0; r < deviations.rows(); ++r) {
    const double one = std::abs(deviations(r, station));
    if (!(one > size)) continue;
    size = one;
    row = r;
  }
  return row;
}

/// Whether it has more than half of the squares.
bool rules(const MatrixRef& deviations, Index row, Index station) {
  const double size = std::abs(deviations(row, station));
  double others = 0.0;
  for (Index r = 0; r < deviations.rows(); ++r) {
    const double part = deviations(r, station) / size;
    if (r != row && !std::isnan(part)) others += part * part;
  }
  return others < 1.0;
}

/// Records that are this much farther from the middle than half of all are: squares of the others are below
/// rounding of the record's.
constexpr double kHides = 1e8;

[[noreturn]] void refuse_record(Index row, Index station, double value) {
  refuse("records[" + std::to_string(row) + ", " + std::to_string(station) + "]", text(value),
         "a number of the size of the others", "it hides all others: correct it, or leave it out (nan)");
}

}  // namespace

void refuse_hiding_record(const MatrixRef& records, const MatrixRef& shown) {
  for (Index k = 0; k < records.cols(); ++k) {
    std::vector<double> values;
    for (const double one : records.col(k))
      if (!std::isnan(one)) values.push_back(one);
    if (values.empty()) continue;
    const double middle = median(values);
    for (double& one : values) one = std::abs(one - middle);
    const double half = median(values);
    const Vector apart = (records.col(k).array() - middle).abs();
    const Index row = largest(apart, 0);
    if (half > 0.0 && apart(row) > kHides * half) refuse_record(row, k, shown(row, k));
  }
}

void refuse_giant_record(const MatrixRef& deviations, const MatrixRef& shown) {
  Index row = -1;
  Index station = -1;
  for (Index k = 0; k < deviations.cols(); ++k) {
    const Index r = largest(deviations, k);
    if (!(std::abs(deviations(r, k)) > 0.0) || !rules(deviations, r, k)) continue;
    if (station >= 0 && !(std::abs(deviations(r, k)) > std::abs(deviations(row, station)))) continue;
    row = r;
    station = k;
  }
  if (station < 0) return;
  refuse_record(row, station, shown(row, station));
}

}  // namespace garrison::detail
