// SPDX-License-Identifier: Apache-2.0
// A program that knows garrison by its umbrella header alone: five agents watch a plant, and how far off they
// are.
#include <cmath>
#include <garrison/garrison.hpp>
#include <iostream>

int main() {
  const garrison::Matrix A = 0.9 * garrison::Matrix::Identity(2, 2);
  const garrison::Matrix both = garrison::Matrix::Identity(2, 2);
  std::vector<garrison::Matrix> C;
  for (int i = 0; i < 5; ++i) C.push_back(both.row(i % 2));
  garrison::Noise noise;
  noise.process_bound = 0.01;
  noise.measurement_bound = garrison::Vector::Constant(5, 0.01);
  const auto filter = garrison::make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{3}}});
  garrison::PlantOptions plant;
  plant.steps = 100;
  plant.x0 = garrison::Vector::Ones(2);
  const garrison::Record run =
      garrison::simulate(garrison::Model(A, C, noise), garrison::Network::ring(5), *filter, plant, {});
  double last = 0.0;
  for (std::size_t i = run.error.size() - 5; i < run.error.size(); ++i) last = std::max(last, run.error[i]);
  std::cout << "garrison " << garrison::version() << ": largest error after 100 samples " << last << '\n';
  // The noise alone holds the true state within 0.1 of zero.
  return std::isfinite(last) && last > 0.0 && last < 0.1 ? 0 : 1;
}
