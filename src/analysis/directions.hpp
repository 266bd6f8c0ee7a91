// SPDX-License-Identifier: Apache-2.0
// lambda_0 for few states, whatever the number of rows and of removals. Internal.
#pragma once

#include "garrison/analysis/subsets.hpp"

namespace garrison::detail {

/// (6) by branch and bound over directions. C: N x n as lambda0 takes it, n <= 3, s <= N - n.
SubsetBound lambda0_by_directions(const MatrixRef& C, int s, const SubsetLimits& limits);

}  // namespace garrison::detail
