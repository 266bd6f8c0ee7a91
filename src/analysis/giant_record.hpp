// SPDX-License-Identifier: Apache-2.0
// One record that hides all others. Internal.
#pragma once

#include "garrison/core/types.hpp"

namespace garrison::detail {

/// Where a fit has failed: refuses a record that has more than half of all squares of its station, names the
/// largest one of such. `deviations`: of the records, samples x stations, NaN = missing. `shown`: the records
/// themselves. @throws InvalidInput
void refuse_giant_record(const MatrixRef& deviations, const MatrixRef& shown);

/// Before a fit: refuses a record beside which all others of its station are rounding, wherever half of them
/// differ.
/// @throws InvalidInput
void refuse_hiding_record(const MatrixRef& records, const MatrixRef& shown);

}  // namespace garrison::detail
