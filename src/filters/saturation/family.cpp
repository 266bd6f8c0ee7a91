// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/runtime/filter_of.hpp"

namespace garrison {
FamilyInfo saturation_family() { return family_info<Saturation>(); }
}  // namespace garrison
