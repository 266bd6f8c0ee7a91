// SPDX-License-Identifier: Apache-2.0
// Every Eigen form of the library is named here, once.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace garrison {

inline constexpr int Dynamic = Eigen::Dynamic;

/// A state vector; `n` is 1..8 at compile time or `Dynamic`.
template <int n>
using Vec = Eigen::Matrix<double, n, 1>;
template <int n>
using Mat = Eigen::Matrix<double, n, n>;

/// Entries of an array on the stack for n numbers, where n is known; else 1, and it is not used.
template <int n>
inline constexpr std::size_t kOnStack = n == Dynamic ? 1 : static_cast<std::size_t>(n);

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
/// Read-only views for public functions: any contiguous double array, no copy.
using VectorRef = Eigen::Ref<const Vector>;
using MatrixRef = Eigen::Ref<const Matrix>;

/// "Does not exist" in every numeric result (a bound that is absent, a missing measurement).
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A measurement or estimate beyond this size is treated as lost: its square would overflow.
inline constexpr double kHuge = 1e150;

}  // namespace garrison
