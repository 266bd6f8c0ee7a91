// SPDX-License-Identifier: Apache-2.0
// What design and check of the platoon share.
#pragma once

#include "garrison/filters/platoon/filter.hpp"

namespace garrison::platoon::detail {

/// From parameters, model and network; the threshold is filled in where it was left out. @throws InvalidInput
Setting setting_of(const Platoon::Params& params, const Model& model, const Network& network);

}  // namespace garrison::platoon::detail
