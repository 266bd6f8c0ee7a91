// SPDX-License-Identifier: Apache-2.0
// Eigen's memory crosses the library's boundary both ways.
#include <garrison/engine/any_filter.hpp>
#include <garrison/version.hpp>

int main() {
  const garrison::Matrix one = garrison::Matrix::Identity(3, 3);
  const garrison::Model model(one, {one, one, one, one});
  const auto prepared = garrison::make_filter("scalar_gain", {})->prepare(model, garrison::Network::ring(4));
  const auto agent = prepared->agent(2);
  return agent->states() == 3 && garrison::version() == GARRISON_VERSION ? 0 : 1;
}
