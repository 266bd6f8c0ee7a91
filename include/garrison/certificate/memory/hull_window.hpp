// SPDX-License-Identifier: Apache-2.0
// Bounded noise, exactly: the smallest box around every state that some set of all but s sources allows.
#pragma once

#include "garrison/certificate/memory/cells.hpp"
#include "garrison/certificate/memory/window.hpp"

namespace garrison::certificate {

/// Per coordinate the hull, over all sets of sources with s left out, of the states that explain every row of
/// the set within its bound: two linear programs per set and coordinate. Holds always (attacked set fixed in
/// the window); whatever a program returns is a bound, also where it stops early. (NaN, NaN): no set is
/// consistent, more than s are attacked; infinite: some set does not determine theta. The window must have
/// bounded rows only, and no prior. Allocates. @throws InvalidInput, also for more than `limit` sets
GARRISON_EXPORT Box hull_window(const Window& window, int s, int limit = 2000);

}  // namespace garrison::certificate
