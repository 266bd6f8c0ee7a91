// SPDX-License-Identifier: Apache-2.0
// Leverage ball (W2): where the state is, from one sample's measurements of which at most s sources lie.
// Any dimension, any s, polynomial. Needs nothing of the network, the filter, the past or the start.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "garrison/certificate/quantiles.hpp"
#include "garrison/certificate/region.hpp"
#include "garrison/certificate/rows.hpp"

namespace garrison::certificate {

/// Answer of a witness.
struct Witness {
  Region region;
  std::vector<char> kept;   ///< per row: neither of a proved source nor refuted
  std::vector<int> proved;  ///< sources shown to be attacked, with those given; none when `region` is refuted
};

/// What a witness may assume.
struct Assumption {
  int s = 0;             ///< at most s of ALL sources are attacked; absent rows do not reduce it
  Levels levels{};       ///< Gaussian noise; unused when bounded
  bool bounded = false;  ///< |v| <= width of each row instead
  /// A region that contains x for certain; none without an answer. Its ball is used. May be null.
  const Region* prior = nullptr;
  /// Sources known to be attacked, each once; with this, the attacked set must never change (S-fixed).
  std::span<const int> proved{};
};

/// Room for leverage_ball, sized once. Movable.
/// Threads: one at a time.
class GARRISON_EXPORT LeverageWorkspace {
 public:
  /// Enough for every Rows(states, sources, capacity) of these sizes. @throws InvalidInput for sizes < 1
  LeverageWorkspace(int states, int sources, int capacity);
  ~LeverageWorkspace();
  LeverageWorkspace(LeverageWorkspace&&) noexcept;
  LeverageWorkspace& operator=(LeverageWorkspace&&) noexcept;

 private:
  friend const Witness& leverage_ball(const Rows&, const Assumption&, LeverageWorkspace&) noexcept;
  struct Room;
  std::unique_ptr<Room> room_;
};

/// Theorem W2. The region contains x whenever at most s sources lie, |v_j| <= z1 sigma_j for the honest rows
/// and their least-squares noise is at most z2 long; both together fail with probability <= rows Q(z1) +
/// delta(z2). With bounded noise always. Does not allocate, cannot fail; the answer lives in the workspace
/// until the next call. O(rows n^2 + n^3) per pass, one pass more for each source that a pass refutes.
/// Expects sizes that fit the workspace, levels >= 0, s >= 0, proved sources in range.
GARRISON_EXPORT const Witness& leverage_ball(const Rows& rows, const Assumption& a,
                                             LeverageWorkspace& room) noexcept;

/// The same, checked, with room of its own; `kept` is by position in `rows`.
/// @throws InvalidInput for s < 0, levels < 0 or not finite, a prior of another dimension or radius < 0,
/// proved sources out of range or twice
GARRISON_EXPORT Witness leverage_ball(const Rows& rows, const Assumption& a);

/// What the checked forms of both witnesses refuse. @throws InvalidInput
void require(const Assumption& a, const Rows& rows);

}  // namespace garrison::certificate
