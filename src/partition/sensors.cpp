// SPDX-License-Identifier: Apache-2.0
#include "partition/sensors.hpp"

#include "garrison/core/random.hpp"

namespace garrison::partition {
namespace {

/// The same number of each of them, or those that are read.
std::vector<double> one_each(double value, const Column* read, std::span<const int> ids) {
  if (read != nullptr) return read->of(ids);
  return std::vector<double>(std::isnan(value) ? 0 : ids.size(), value);
}

}  // namespace

Matrix Sensors::row(int id) const {
  if (!C.empty()) return C[static_cast<std::size_t>(id)];
  const Random random(seed, 0, Purpose::position, 1);
  Matrix row(1, A.rows());
  for (Eigen::Index k = 0; k < row.cols(); ++k)
    row(0, k) = random.normal(0, static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(k));
  return row / row.norm();
}

std::vector<Matrix> Sensors::rows(std::span<const int> ids) const {
  std::vector<Matrix> all;
  if (rows_read == nullptr) {
    for (const int id : ids) all.push_back(row(id));
    return all;
  }
  const std::vector<double> numbers = rows_read->of(ids);
  const Eigen::Index n = A.rows();
  for (std::size_t k = 0; k < ids.size(); ++k)
    all.emplace_back(
        Eigen::Map<const Matrix>(numbers.data() + k * static_cast<std::size_t>(n), n, 1).transpose());
  return all;
}

Model Sensors::model(std::span<const int> ids) const {
  std::vector<Matrix> all = rows(ids);
  Noise noise;
  noise.process_bound = process_bound;
  noise.process_covariance = process_covariance;
  const auto variances = one_each(measurement_variance, variances_read.get(), ids);
  for (std::size_t k = 0; k < variances.size(); ++k) {
    const auto outputs = all[k].rows();
    noise.measurement_covariance.push_back(variances[k] * Matrix::Identity(outputs, outputs));
  }
  const auto bounds = one_each(measurement_bound, bounds_read.get(), ids);
  noise.measurement_bound = Eigen::Map<const Vector>(bounds.data(), static_cast<Eigen::Index>(bounds.size()));
  return {A, std::move(all), std::move(noise)};
}

}  // namespace garrison::partition
