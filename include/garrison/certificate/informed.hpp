// SPDX-License-Identifier: Apache-2.0
// After all s attackers are proved (I): the error system is exactly linear. Needs a sound detector, an
// attacked set that never changes, and lossless steps since.
#pragma once

#include "garrison/certificate/error_system.hpp"
#include "garrison/certificate/kernels.hpp"

namespace garrison::certificate {

/// t0 from which everybody's list is complete: the step at whose end the first list reached s ids, and the
/// steps that flooding takes. diameter >= 0, rounds >= 1 hops per step. @throws InvalidInput
GARRISON_EXPORT int lists_complete(int step, int diameter, int rounds);

/// Theorem I, bounded noise: row k-1 bounds ||e_i(t0 + k)||, k = 1..steps, column = agent.
/// `system`: error_system with the proved sensors silent. start: N bounds on ||e_l(t0)|| that hold for ALL
/// agents. bw >= 0; bv: N numbers >= 0. O(steps (Nn)^3), once per proved set. @throws InvalidInput
GARRISON_EXPORT Gains informed(const ErrorSystem& system, const VectorRef& start, int steps, double bw,
                               const VectorRef& bv);

/// Gaussian noise: each row and agent fails with probability delta. P0: Nn x Nn, law of the noise part at t0;
/// zero unless t0 was fixed in advance, because t0 depends on the noise before it. @throws InvalidInput
GARRISON_EXPORT Gains informed(const ErrorSystem& system, const VectorRef& start, int steps,
                               const MatrixRef& Q, const VectorRef& R, const MatrixRef& P0, double delta);

}  // namespace garrison::certificate
