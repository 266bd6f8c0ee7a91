// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/filter_of.hpp"
#include "garrison/filters/platoon/baseline.hpp"
#include "garrison/filters/platoon/filter.hpp"

namespace garrison {
template FamilyInfo family_info<Platoon>();
template FamilyInfo family_info<PlatoonBaseline>();
}  // namespace garrison
