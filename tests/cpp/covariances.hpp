// SPDX-License-Identifier: Apache-2.0
// Models that families with gains from covariances can be designed for.
#pragma once

#include <utility>

#include "garrison/core/model.hpp"

namespace garrison::test {

/// The model with covariances of noise that is uniform within its bounds; scalar outputs.
inline Model with_covariances(const Model& model) {
  Noise noise = model.noise();
  const double process = noise.process_bound * noise.process_bound / (model.states() + 2.0);
  noise.process_covariance = process * Matrix::Identity(model.states(), model.states());
  std::vector<Matrix> C;
  for (int i = 0; i < model.agents(); ++i) {
    C.push_back(model.C(i));
    noise.measurement_covariance.emplace_back(
        Matrix::Constant(1, 1, noise.measurement_bound(i) * noise.measurement_bound(i) / 3.0));
  }
  return {model.A(), std::move(C), std::move(noise)};
}

}  // namespace garrison::test
