// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/structural/filter.hpp"
#include "garrison/runtime/filter_of.hpp"

namespace garrison {
FamilyInfo structural_family() { return family_info<Structural>(); }
}  // namespace garrison
