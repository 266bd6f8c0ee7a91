// SPDX-License-Identifier: Apache-2.0
// Every filter family, in the order in which they are shown. A new one is its folder, its include and its
// name in the list: registry, bindings and Python classes follow.
#pragma once

#include "garrison/filters/lfre.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/platoon/baseline.hpp"
#include "garrison/filters/platoon/filter.hpp"
#include "garrison/filters/rdkf/filter.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/filters/scalar_gain.hpp"
#include "garrison/filters/structural/filter.hpp"

namespace garrison {

template <class... F>
struct FamilyList {
  static constexpr std::size_t size = sizeof...(F);
  /// Calls `action.operator()<F>()` for every family.
  template <class Action>
  static void each(const Action& action) {
    (action.template operator()<F>(), ...);
  }
};

using Families =
    FamilyList<Saturation, ScalarGain, Lfre, Rdkf, Dkf, PartialSharing, Structural, Platoon, PlatoonBaseline>;

}  // namespace garrison
