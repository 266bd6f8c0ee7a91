// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/filter_of.hpp"
#include "garrison/filters/platoon/baseline.hpp"
#include "garrison/filters/platoon/filter.hpp"

namespace garrison {
FamilyInfo platoon_family() { return family_info<Platoon>(); }
FamilyInfo platoon_baseline_family() { return family_info<PlatoonBaseline>(); }
}  // namespace garrison
