// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/scalar_gain.hpp"

#include "garrison/engine/filter_of.hpp"

namespace garrison {
FamilyInfo scalar_gain_family() { return family_info<ScalarGain>(); }
}  // namespace garrison
