// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/partial_sharing/together.hpp"
#include "garrison/runtime/filter_of.hpp"

namespace garrison {
FamilyInfo partial_sharing_family() { return family_info<PartialSharing>(); }
}  // namespace garrison
