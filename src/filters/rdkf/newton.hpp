// SPDX-License-Identifier: Apache-2.0
// Equation (5) by Newton's method, for plants whose sweeps are slow to settle.
#pragma once

#include "garrison/filters/rdkf/steady_state.hpp"

namespace garrison::rdkf {

/// Newton's method on (5). The solution for more process noise is an upper bound, as it needs one to start
/// from; with enough noise the sweeps settle quickly. From there the noise falls step by step, so that an
/// upper bound is never so much larger than the solution that rounding hides what is well known.
bool newton(const Setting& given, SteadyState& out);

/// The rest of the way from a P near the solution, where modes need more samples than there were sweeps:
/// Newton's method in units in which the diagonal of P is about 1, so that no state is lost in the rounding
/// of another. Its start need not be an upper bound, but only so good that the gains at it are stable.
bool finish(const Setting& given, SteadyState& out);

}  // namespace garrison::rdkf
