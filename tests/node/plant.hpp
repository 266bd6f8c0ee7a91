// SPDX-License-Identifier: Apache-2.0
// The plant of a simulated run, and what its sensors say of it.
#pragma once

#include <memory>
#include <vector>

#include "faults.hpp"
#include "garrison/engine/any_filter.hpp"

namespace garrison::node::test {

/// A turning plant, sensors all around, neighbours at distance one and two on a ring. Made once.
const std::shared_ptr<const Prepared>& shared_design(int agents);

struct Plant {
  Plant(const Model& model, const Faults& faults, int samples, std::uint64_t seed, Seeded& random);

  Vector x0;                                      ///< what all start with
  std::vector<Vector> states;                     ///< [sample]
  std::vector<std::vector<double>> measurements;  ///< [sample][agent], as the attacker left them
};

}  // namespace garrison::node::test
