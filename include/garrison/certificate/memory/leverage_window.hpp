// SPDX-License-Identifier: Apache-2.0
// Leverage ball with memory (W2M): where the state is, from the rows of several steps. Any s, polynomial; the
// attacked set may be fixed or move in every step.
#pragma once

#include <memory>

#include "garrison/certificate/memory/levels.hpp"
#include "garrison/certificate/memory/window.hpp"

namespace garrison::certificate {

/// Room for leverage_window, sized once. Movable.
/// Threads: one at a time.
class GARRISON_EXPORT LeverageWindowWorkspace {
 public:
  /// Enough for every window of the sizes of this one.
  explicit LeverageWindowWorkspace(const Window& window);
  ~LeverageWindowWorkspace();
  LeverageWindowWorkspace(LeverageWindowWorkspace&&) noexcept;
  LeverageWindowWorkspace& operator=(LeverageWindowWorkspace&&) noexcept;

  struct Room;

 private:
  friend const WindowWitness& leverage_window(const Window&, const WindowAssumption&,
                                              LeverageWindowWorkspace&) noexcept;
  std::unique_ptr<Room> room_;
};

/// Theorem W2M. The region (ellipsoid, box, ball) contains x(steps-1), and no honest source is dropped, with
/// probability >= 1 - 2 rows P(|N| > z1) - delta(z2) - n P(|N| > zc); with bounded noise and levels 0 always.
/// Does not allocate, cannot fail; the answer lives in the workspace until the next call. O(rows^2 unknowns)
/// a pass. Expects a window of the sizes of the workspace's and an assumption that require() accepts.
GARRISON_EXPORT const WindowWitness& leverage_window(const Window& window, const WindowAssumption& a,
                                                     LeverageWindowWorkspace& room) noexcept;

/// The same, checked, with room of its own. @throws InvalidInput as require()
GARRISON_EXPORT WindowWitness leverage_window(const Window& window, const WindowAssumption& a);

/// What the checked forms refuse: s < 0, levels < 0 or not finite, sources out of range or twice, `proved`
/// with a moving set, a window whose last step is not reached. @throws InvalidInput
void require(const WindowAssumption& a, const Window& window);

}  // namespace garrison::certificate
