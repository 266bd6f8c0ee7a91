// SPDX-License-Identifier: Apache-2.0
// What families say of plants that change in time; see Filter (core/filter.hpp).
#pragma once

#include <string>

#include "garrison/core/change.hpp"
#include "garrison/core/filter.hpp"

namespace garrison {

/// Why the family cannot take a plant that changes, in words; empty: it can.
template <class F>
std::string why_constant(const typename F::Gains& gains) {
  if constexpr (requires { F::needs_constant(gains); })
    return F::needs_constant(gains);
  else
    return "its gains are designed for one A and C";
}

/// Whether gains of the family follow a plant that changes.
template <class F, int n>
constexpr bool follows() {
  return requires(const Local& local, const typename F::Gains& gains, const Change& change,
                  typename F::template State<n>& state) {
    F::template vary<n>(local, gains, change, 0, state);
  };
}

}  // namespace garrison
