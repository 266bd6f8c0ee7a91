// SPDX-License-Identifier: Apache-2.0
#include "plant.hpp"

#include <cmath>
#include <numbers>

namespace garrison::node::test {

namespace {
Vector direction(double angle) { return Vector{{std::cos(angle), std::sin(angle)}}; }

std::shared_ptr<const Prepared> design(int agents) {
  const double turn = 0.05;
  Matrix A{{std::cos(turn), -std::sin(turn)}, {std::sin(turn), std::cos(turn)}};
  A *= 0.98;
  std::vector<Matrix> C;
  std::vector<Edge> edges;
  for (int i = 0; i < agents; ++i) {
    C.push_back(direction(std::numbers::pi * i / agents).transpose());
    for (const int step : {1, 2})
      edges.emplace_back(std::min(i, (i + step) % agents), std::max(i, (i + step) % agents));
  }
  const Model model(A, C, {0.002, Vector::Constant(agents, 0.01), {}, {}});
  return make_filter("saturation", {{"threshold", 1.0},
                                    {"rounds", std::int64_t{3}},
                                    {"attacked", std::int64_t{1}},
                                    {"initial_error", 1.0},
                                    {"detector", true}})
      ->prepare(model, Network(agents, edges));
}
}  // namespace

const std::shared_ptr<const Prepared>& shared_design(int agents) {
  static const auto made = design(agents);
  return made;
}

Plant::Plant(const Model& model, const Faults& faults, int samples, std::uint64_t seed, Seeded& random)
    : x0(Vector{{1.0, 0.0}}) {
  Vector x = x0 + 0.99 * random.uniform() * direction(2 * std::numbers::pi * random.uniform());
  for (int t = 0; t <= samples; ++t) {
    states.push_back(x);
    std::vector<double> y;
    for (int i = 0; i < model.agents(); ++i) y.push_back((model.C(i) * x)(0) + 0.01 * random.signed_unit());
    if (faults.attacked && t > 20) {
      const double lies[] = {0.3, 50.0 * random.signed_unit(), 0.02 * t};
      y[static_cast<std::size_t>(*faults.attacked)] += lies[seed % 3];
    }
    measurements.push_back(y);
    x = model.A() * x + 0.002 * random.uniform() * direction(2 * std::numbers::pi * random.uniform());
  }
}

}  // namespace garrison::node::test
