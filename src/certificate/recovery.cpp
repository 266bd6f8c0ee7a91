// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/recovery.hpp"

#include <algorithm>
#include <utility>

namespace garrison::certificate {

Recovery::Recovery(const Kernels& kernels, int s) {
  const TableOptions homogeneous{s, 1.0, kernels.window(), {}, false};
  Table t = table(kernels, homogeneous, 0.0, Vector::Zero(kernels.system.agents()));
  rb_ = std::move(t.d);
  re_ = std::move(t.eta);
  rmax_ = rb_.rowwise().maxCoeff();
}

LossState Recovery::rebase(LossState state, int t) const noexcept {
  const int K = window();
  for (int next = (state.lam / K + 1) * K; next <= t; next += K) {
    // Nothing stays nothing, also where the table overflowed.
    if (state.x != 0.0) state.x *= rmax_(next - state.lam);
    state.lam = next;
  }
  return state;
}

double Recovery::error_excess(int agent, LossState state, int t) const noexcept {
  const LossState seen = rebase(state, t);
  return seen.x == 0.0 ? 0.0 : rb_(t - seen.lam, agent) * seen.x;
}

double Recovery::level_excess(int agent, LossState state, int t) const noexcept {
  const LossState seen = rebase(state, t);
  return seen.x == 0.0 ? 0.0 : re_(t - seen.lam, agent) * seen.x;
}

LossState Recovery::merge(LossState p, LossState q, int t) const noexcept {
  p = rebase(p, t);
  q = rebase(q, t);
  if (std::pair(q.lam, q.x) < std::pair(p.lam, p.x)) std::swap(p, q);
  const double carried = p.x == 0.0 ? 0.0 : rmax_(q.lam - p.lam) * p.x;
  return {q.lam, std::max(q.x, carried)};
}

}  // namespace garrison::certificate
