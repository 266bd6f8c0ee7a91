// SPDX-License-Identifier: Apache-2.0
// What a covariance must be.
#pragma once

#include <string>

#include "garrison/core/abi.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// Refuses a matrix, square and finite, that is not symmetric and positive semidefinite. @throws InvalidInput
GARRISON_EXPORT void require_covariance(const std::string& which, const Matrix& S);

}  // namespace garrison
