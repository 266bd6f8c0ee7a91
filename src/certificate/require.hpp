// SPDX-License-Identifier: Apache-2.0
// What the certificates refuse, in one form. Internal.
#pragma once

#include <string>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate::detail {

/// Arrays beyond this many numbers are refused instead of exhausting the memory.
inline constexpr double kMostNumbers = 1e8;

inline std::string shape(const MatrixRef& m) {
  return std::to_string(m.rows()) + " x " + std::to_string(m.cols());
}

inline void require_least(const char* which, double value, double least) {
  if (!(value >= least) || value > kHuge) refuse(which, text(value), "a finite number >= " + text(least));
}

inline void require_least(const char* which, int value, int least) {
  if (value < least) refuse(which, std::to_string(value), "a whole number >= " + std::to_string(least));
}

inline void require_shape(const char* which, const MatrixRef& m, Eigen::Index rows, Eigen::Index columns) {
  if (m.rows() != rows || m.cols() != columns)
    refuse(which, shape(m), std::to_string(rows) + " x " + std::to_string(columns));
  if (m.size() > 0 && !(m.cwiseAbs().maxCoeff() <= kHuge))
    refuse(which, "a number that is not finite or beyond 1e150", "finite numbers");
}

/// N numbers >= 0.
inline void require_bounds(const char* which, const VectorRef& v, Eigen::Index size) {
  require_shape(which, v, size, 1);
  if (size > 0 && v.minCoeff() < 0.0) refuse(which, text(v.minCoeff()), "numbers >= 0");
}

inline void require_room(const char* which, double numbers) {
  if (numbers > kMostNumbers) refuse(which, text(numbers) + " numbers to keep", "at most 1e8", "take less");
}

/// Symmetric to 1e-9 of its largest entry, no eigenvalue below -1e-9 of it.
void require_covariance(const char* which, const MatrixRef& P, Eigen::Index size);

}  // namespace garrison::certificate::detail
