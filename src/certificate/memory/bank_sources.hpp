// SPDX-License-Identifier: Apache-2.0
// What the bank and its design-time theorem refuse of sources. Internal.
#pragma once

#include "garrison/certificate/memory/bank.hpp"

namespace garrison::certificate::detail {

/// At least one source, outputs of n columns, variances > 0. @throws InvalidInput
void require_sources(const std::vector<BankSource>& sources, Eigen::Index n);

}  // namespace garrison::certificate::detail
