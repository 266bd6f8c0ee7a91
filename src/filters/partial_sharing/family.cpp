// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/filter_of.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/partial_sharing/side_by_side.hpp"

namespace garrison {
template FamilyInfo family_info<PartialSharing>();
}  // namespace garrison
