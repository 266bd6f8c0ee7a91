// SPDX-License-Identifier: Apache-2.0
// Eight agents in a ring watch one plant; from sample 50 on, the sensor of agent 3 lies. A filter that limits
// what a measurement may do, and one that trusts them all.
#include <algorithm>
#include <cstdio>
#include <garrison/garrison.hpp>

using namespace garrison;

/// A slow rotation; every agent measures one of the two states.
Model plant(int agents) {
  const Matrix A{{0.99, 0.05}, {-0.05, 0.99}};
  std::vector<Matrix> C;
  for (int i = 0; i < agents; ++i) C.push_back(Matrix::Identity(2, 2).row(i % 2));
  Noise noise;
  noise.process_bound = 0.01;
  noise.measurement_bound = Vector::Constant(agents, 0.02);
  return {A, C, noise};
}

/// The largest error of any agent in the second half of the run.
double worst(const Record& run) {
  const auto half = static_cast<std::ptrdiff_t>(run.error.size() / 2);
  return *std::max_element(run.error.begin() + half, run.error.end());
}

int main() {
  const Model model = plant(8);
  const Network network = Network::ring(8);
  PlantOptions start;
  start.steps = 200;
  start.x0 = Vector::Ones(2);
  RunOptions options;
  options.attacks = {bias(Schedule(50, {3}), 4.0)};

  const auto screened = make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{10}}});
  const auto trusting = make_filter("scalar_gain", {{"rounds", std::int64_t{10}}});
  try {
    for (const auto& filter : {screened, trusting}) {
      const Record run = simulate(model, network, *filter, start, options);
      std::printf("%-11s  largest error under attack %.2f\n", filter->name().c_str(), worst(run));
    }
    make_filter("saturation", {{"treshold", 0.5}});
  } catch (const InvalidInput& error) {
    std::printf("%s\n", error.what());
  }
}
