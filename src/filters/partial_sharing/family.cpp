// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/filter_of.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/partial_sharing/together.hpp"

namespace garrison {
template FamilyInfo family_info<PartialSharing>();
}  // namespace garrison
