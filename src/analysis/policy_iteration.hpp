// SPDX-License-Identifier: Apache-2.0
// Fixed points of coupled Riccati maps, however slowly their recursion converges. Internal.
#pragma once

#include <vector>

#include "garrison/core/types.hpp"

namespace garrison::detail {

using Matrices = std::vector<Matrix>;

/// F(P) = minimum over policies (gains) of L(P) + offset, one symmetric matrix per agent, L linear and
/// positive.
class RiccatiMap {
 public:
  virtual ~RiccatiMap() = default;
  /// F(P) - P to more digits than P itself has; the policy that is best at P is kept for apply().
  virtual Matrices residual(const Matrices& P) = 0;
  /// L(D) of the policy kept.
  virtual Matrices apply(const Matrices& D) const = 0;
};

struct FixedPoint {
  Matrices P;
  int steps = 0;
  double change = 0.0;  ///< relative change of an entry in the last step
  bool converged = false;
};

/// Newton's method (policy iteration, Kleinman 1968) from a `start` with F(start) <= start: it falls
/// monotonically to the greatest fixed point, at the end quadratically. Each step solves (I - L) D = F(P) - P
/// by GMRES.
FixedPoint policy_iteration(RiccatiMap& map, Matrices start);

}  // namespace garrison::detail
