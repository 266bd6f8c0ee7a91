// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/filter_of.hpp"
#include "garrison/filters/rdkf/filter.hpp"

namespace garrison {
// In one place: both run the same engine.
template FamilyInfo family_info<Rdkf>();
template FamilyInfo family_info<Dkf>();
}  // namespace garrison
