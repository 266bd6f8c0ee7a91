// SPDX-License-Identifier: Apache-2.0
// An attacked run, and agents that read their parts of its design: the same bits.
#pragma once

#include <doctest/doctest.h>

#include <cstring>

#include "../../agents_by_hand.hpp"
#include "garrison/attacks/measurement.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/design_file.hpp"

namespace garrison::test {

/// The run of five agents with one output each and two states, of which agent 3 lies from sample 10 on, after
/// agents driven by bytes have shown the same bounds, kinds and thresholds.
inline Record run_by_parts(const Prepared& prepared, int steps) {
  RunOptions o;
  o.attacks = {bias(Schedule(10, {3}), 0.6)};
  Record run = simulate(prepared, {steps, Vector::Zero(2), 0.5}, o);
  AgentsByHand agents(prepared, prepared.network());
  for (int i = 0; i < 5; ++i) {
    agents.all()[static_cast<std::size_t>(i)] = read_part(write_part(prepared, i));
    REQUIRE(agents[i].reset(Vector(Eigen::Map<const Vector>(run.estimate.data() + 2 * i, 2))) ==
            Refusal::none);
  }
  for (int t = 1; t <= steps; ++t) {
    agents.step(t, [&](int i) {
      return Vector::Constant(1, run.measurements[static_cast<std::size_t>(5 * (t - 1) + i)]);
    });
    for (int i = 0; i < 5; ++i) {
      const Report report = agents[i].report();
      const auto at = static_cast<std::size_t>(5 * t + i);
      REQUIRE(std::memcmp(&report.bound, &run.bound[at], sizeof(double)) == 0);
      REQUIRE(static_cast<std::uint8_t>(report.kind) == run.bound_kind[at]);
      REQUIRE(std::memcmp(&report.threshold, &run.threshold[at], sizeof(double)) == 0);
    }
  }
  return run;
}

}  // namespace garrison::test
