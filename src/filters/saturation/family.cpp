// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/filter_of.hpp"
#include "garrison/filters/saturation/filter.hpp"

namespace garrison {
template FamilyInfo family_info<Saturation>();
}  // namespace garrison
