// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/scalar_gain.hpp"

#include "garrison/engine/filter_of.hpp"

namespace garrison {
template FamilyInfo family_info<ScalarGain>();
}  // namespace garrison
