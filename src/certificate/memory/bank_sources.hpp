// SPDX-License-Identifier: Apache-2.0
// What the bank and its design-time theorem refuse of sources. Internal.
#pragma once

#include "garrison/certificate/memory/bank.hpp"

namespace garrison::certificate::detail {

/// At least one source, outputs of n columns, variances > 0. @throws InvalidInput
void require_sources(const std::vector<BankSource>& sources, Eigen::Index n);

/// The same, a plant x+ = A x + w with cov w = Q, and s of the sources. @throws InvalidInput
void require_bank(const MatrixRef& A, const MatrixRef& Q, const std::vector<BankSource>& sources, int s);

}  // namespace garrison::certificate::detail
