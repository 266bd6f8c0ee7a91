// SPDX-License-Identifier: Apache-2.0
// Anytime search (A): from W2M (one leaf) to W3M (all leaves), valid after any number of splits.
#pragma once

#include <memory>

#include "garrison/certificate/memory/levels.hpp"
#include "garrison/certificate/memory/window.hpp"

namespace garrison::certificate {

/// Room for anytime_window, sized once. Movable.
/// Threads: one at a time.
class GARRISON_EXPORT AnytimeWindowWorkspace {
 public:
  /// Enough for every window of the sizes of this one and at most `leaves` >= 1 leaves. @throws InvalidInput
  AnytimeWindowWorkspace(const Window& window, int leaves);
  ~AnytimeWindowWorkspace();
  AnytimeWindowWorkspace(AnytimeWindowWorkspace&&) noexcept;
  AnytimeWindowWorkspace& operator=(AnytimeWindowWorkspace&&) noexcept;

  struct Room;

 private:
  friend const WindowWitness& anytime_window(const Window&, const WindowAssumption&,
                                             AnytimeWindowWorkspace&) noexcept;
  std::unique_ptr<Room> room_;
};

/// Theorem A, attacked set fixed in the window. A leaf takes some sources as attacked and some as honest and
/// asks W2M; the widest leaf is split on its most influential undecided source until the workspace is full.
/// The region encloses all leaves; a source that every leaf drops is proved. Fails as W2M, and with rows
/// P(|N| > z1) more for the residual test of decided leaves. The cost is leaves x W2M: the budget. Does not
/// allocate, cannot fail; the answer lives in the workspace until the next call.
GARRISON_EXPORT const WindowWitness& anytime_window(const Window& window, const WindowAssumption& a,
                                                    AnytimeWindowWorkspace& room) noexcept;
/// The same, checked, with room of its own. @throws InvalidInput as require(), for a moving set, and for
/// leaves < 1
GARRISON_EXPORT WindowWitness anytime_window(const Window& window, const WindowAssumption& a, int leaves);

}  // namespace garrison::certificate
