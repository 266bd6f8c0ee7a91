// SPDX-License-Identifier: Apache-2.0
#include "partition/sensors.hpp"

#include "garrison/core/random.hpp"

namespace garrison::partition {

Matrix Sensors::rows(int id) const {
  if (!C.empty()) return C[static_cast<std::size_t>(id)];
  const Random random(seed, 0, Purpose::position, 1);
  Matrix row(1, A.rows());
  for (Eigen::Index k = 0; k < row.cols(); ++k)
    row(0, k) = random.normal(0, static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(k));
  return row / row.norm();
}

Model Sensors::model(std::span<const int> ids) const {
  std::vector<Matrix> all;
  Noise noise;
  noise.process_bound = process_bound;
  noise.process_covariance = process_covariance;
  for (const int id : ids) {
    all.push_back(rows(id));
    const auto outputs = all.back().rows();
    if (!std::isnan(measurement_variance))
      noise.measurement_covariance.push_back(measurement_variance * Matrix::Identity(outputs, outputs));
  }
  if (!std::isnan(measurement_bound))
    noise.measurement_bound = Vector::Constant(static_cast<Eigen::Index>(ids.size()), measurement_bound);
  return {A, std::move(all), std::move(noise)};
}

}  // namespace garrison::partition
