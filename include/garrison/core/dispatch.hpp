// SPDX-License-Identifier: Apache-2.0
// From the state dimension at run time to the one at compile time.
#pragma once

#include "garrison/core/types.hpp"

namespace garrison {

/// Calls `action.operator()<n>()` with n = states for 2 and 4, Dynamic for others: for what runs once a
/// sample on one agent. The bits are those of every n.
template <class Action>
auto dispatch_few(int states, const Action& action) {
  switch (states) {
    case 2:
      return action.template operator()<2>();
    case 4:
      return action.template operator()<4>();
    default:
      return action.template operator()<Dynamic>();
  }
}

/// The same for 1..8. Builds for the sanitizers, where every dimension costs minutes and is the same source,
/// have 2, 4 and 8 only.
template <class Action>
auto dispatch(int states, const Action& action) {
  switch (states) {
#ifndef GARRISON_FEW_DIMENSIONS
    case 1:
      return action.template operator()<1>();
    case 3:
      return action.template operator()<3>();
    case 5:
      return action.template operator()<5>();
    case 6:
      return action.template operator()<6>();
    case 7:
      return action.template operator()<7>();
#endif
    case 8:
      return action.template operator()<8>();
    default:
      return dispatch_few(states, action);
  }
}

}  // namespace garrison
