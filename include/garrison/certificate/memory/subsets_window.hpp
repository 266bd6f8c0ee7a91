// SPDX-License-Identifier: Apache-2.0
// Subset witness with memory (W3M): the union over all sets of s sources left out of a window, and its width
// at design time (W3D).
#pragma once

#include <memory>

#include "garrison/certificate/memory/levels.hpp"
#include "garrison/certificate/memory/window.hpp"

namespace garrison::certificate {

/// Sets that are tried at most, without another wish.
inline constexpr int kMostWindowSubsets = 3000;

/// Room for subsets_window, sized once. Movable.
/// Threads: one at a time.
class GARRISON_EXPORT SubsetsWindowWorkspace {
 public:
  /// Enough for every window of the sizes of this one and at most `limit` sets. @throws InvalidInput
  explicit SubsetsWindowWorkspace(const Window& window, int limit = kMostWindowSubsets);
  ~SubsetsWindowWorkspace();
  SubsetsWindowWorkspace(SubsetsWindowWorkspace&&) noexcept;
  SubsetsWindowWorkspace& operator=(SubsetsWindowWorkspace&&) noexcept;

  struct Room;

 private:
  friend const WindowWitness& subsets_window(const Window&, const WindowAssumption&,
                                             SubsetsWindowWorkspace&) noexcept;
  std::unique_ptr<Room> room_;
};

/// How many sets subsets_window would try; 0 when the proved sources alone are more than s.
double subsets_to_try(const Window& window, const WindowAssumption& a) noexcept;

/// Theorem W3M, attacked set fixed in the window. A set of sources is kept when its least-squares theta
/// explains its own rows within z1 of their residuals' deviations (and together within z3); the region
/// encloses those of all kept sets; a source in none of them is proved (with at least 2s sources at hand; no
/// honest one except with twice the probability that follows). Fails with probability <= rows P(|N| > z1) +
/// delta(z2) + n P(|N| > zc) + delta(z3). Radius = infinity also when there are more sets than the workspace
/// has room for. `honest` is not used. Does not allocate, cannot fail. O(sets (unknowns^3 + rows
/// unknowns^2)).
GARRISON_EXPORT const WindowWitness& subsets_window(const Window& window, const WindowAssumption& a,
                                                    SubsetsWindowWorkspace& room) noexcept;
/// The same, checked, with room of its own. @throws InvalidInput as require(), for a moving set or sources
/// taken as honest, and for more than `limit` sets
GARRISON_EXPORT WindowWitness subsets_window(const Window& window, const WindowAssumption& a,
                                             int limit = kMostWindowSubsets);

/// Theorem W3D: half width per coordinate that subsets_window never exceeds, whatever at most s attackers do;
/// n numbers, infinite when some 2s sources hold the only information. Reads the rows, not their data. Levels
/// as for subsets_window, at delta / C(sources, s) for "with probability 1 - delta". @throws InvalidInput as
/// subsets_window, counting pairs of sets
GARRISON_EXPORT Vector subsets_window_width(const Window& window, const WindowAssumption& a,
                                            int limit = 20 * kMostWindowSubsets);

}  // namespace garrison::certificate
