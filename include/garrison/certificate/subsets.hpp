// SPDX-License-Identifier: Apache-2.0
// Subset witness (W3): the union over all sets that may be the honest ones. Sharper than W2, as long as few
// sets exist: C(sources at hand, s).
#pragma once

#include "garrison/certificate/leverage_ball.hpp"

namespace garrison::certificate {

/// How many sets are tried at most: some 20 ms in four dimensions.
inline constexpr int kMostSubsets = 5000;

/// Room for witness_subsets, sized once. Movable.
/// Threads: one at a time.
class GARRISON_EXPORT SubsetsWorkspace {
 public:
  /// Enough for every Rows(states, sources, capacity) of these sizes and at most `limit` sets.
  /// @throws InvalidInput for sizes < 1 or more than 1e8 numbers
  SubsetsWorkspace(int states, int sources, int capacity, int limit = kMostSubsets);
  ~SubsetsWorkspace();
  SubsetsWorkspace(SubsetsWorkspace&&) noexcept;
  SubsetsWorkspace& operator=(SubsetsWorkspace&&) noexcept;

 private:
  friend const Witness& witness_subsets(const Rows&, const Assumption&, double, SubsetsWorkspace&) noexcept;
  struct Room;
  std::unique_ptr<Room> room_;
};

/// How many sets witness_subsets would try; 0 when it answers without: nothing but liars at hand, or a
/// refutation.
double subsets_to_try(const Rows& rows, const Assumption& a) noexcept;

/// Theorem W3, Gaussian noise. Every set of (sources at hand - s) sources whose least-squares state explains
/// its own rows is consistent; the region encloses their ellipsoids. A source in no consistent set is proved
/// attacked. Fails with probability <= rows Q(z1) + delta(z2) + delta(z3); with sources at hand >= 2 s no
/// honest source is reported as proved except with probability rows Q(z1) + 2 delta(z2) + 2 delta(z3). `z3`:
/// chi(delta3, rows - n) for the rows of such a set, also tests the whole residual (only where the law of the
/// noise is known); NaN = not used. Assumption::prior and Assumption::bounded are not used. With `proved`,
/// the attacked set must never change. Radius = infinity also when there are more sets than the workspace has
/// room for: ask subsets_to_try(). Does not allocate, cannot fail; the answer lives in the workspace until
/// the next call. O(sets (rows n^2 + n^3)). Expects what leverage_ball expects, and z3 >= 0 or NaN.
GARRISON_EXPORT const Witness& witness_subsets(const Rows& rows, const Assumption& a, double z3,
                                               SubsetsWorkspace& room) noexcept;

/// The same, checked, with room of its own.
/// @throws InvalidInput as leverage_ball, and for a prior, bounded noise, z3 < 0 or infinite, more than
/// `limit` sets
GARRISON_EXPORT Witness witness_subsets(const Rows& rows, const Assumption& a, double z3 = kNaN,
                                        int limit = kMostSubsets);

}  // namespace garrison::certificate
