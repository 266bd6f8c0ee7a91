// SPDX-License-Identifier: Apache-2.0
// Families that step several agents of a network at once (docs/adr/0006).
#pragma once

#include "garrison/core/types.hpp"

namespace garrison {

/// A family may have an F::Together<n>, which gives every agent's state a place beside those of others:
/// - `join(states, count, local)` once, before `init`; `local(k)` is the Local of agent k in the engine's
/// order;
/// - `start(gains, local)` after every agent's `init`;
/// - `agreed()`: whether messages over perfect links would tell what neighbours can read directly; if so
/// - `step(gains, local(0), t, y, wiring, workers)` is one sample without messages, `y(k)` being the
///   measurements of agent k; else `sense` agent by agent as ever, and then
/// - `fuse(gains, local(0), inbox, workers)`, the only round, from the inboxes `inbox(k)`.
/// Bits are those of agents on their own, for any number of threads; nothing is allocated after `start`.
template <class F, int n>
concept StepsTogether = n != Dynamic && requires { typename F::template Together<n>; };

namespace detail {
template <class F, int n>
struct TogetherOf {
  struct type {};
};
template <class F, int n>
  requires StepsTogether<F, n>
struct TogetherOf<F, n> {
  using type = typename F::template Together<n>;
};
}  // namespace detail

}  // namespace garrison
