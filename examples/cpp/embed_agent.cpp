// SPDX-License-Identifier: Apache-2.0
// Agents that are driven by hand, as in a program that has its own clock and its own link: what agent 2
// knows, sample by sample, and that these are the bits of a replay of the same measurements.
#include <cmath>
#include <cstdio>
#include <garrison/garrison.hpp>

#include "exchange.hpp"

using namespace garrison;

int main() {
  constexpr int N = 5, steps = 60;
  std::vector<Matrix> C;
  for (int i = 0; i < N; ++i) C.push_back(Matrix::Identity(2, 2).row(i % 2));
  Noise noise;
  noise.process_bound = 0.0;
  noise.measurement_bound = Vector::Constant(N, 0.01);
  const Model model(Matrix{{1.0, 0.1}, {0.0, 1.0}}, C, noise);
  const Network network = Network::ring(N);
  const auto filter =
      make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{4}}, {"initial_error", 2.0}});

  // One design, any number of agents; each of them belongs to one thread at a time.
  const auto prepared = filter->prepare(model, network);
  std::vector<std::unique_ptr<Agent>> agents;
  for (int i = 0; i < N; ++i) agents.push_back(prepared->agent(i));
  for (const auto& agent : agents)
    if (agent->reset(Vector::Zero(2)) != Refusal::none) return 1;

  Matrix recorded(steps, N);
  Vector x{{1.0, 0.05}};
  std::vector<Post> posts;
  for (int t = 1; t <= steps; ++t) {
    x = model.A() * x;
    std::vector<std::vector<double>> y;
    for (int i = 0; i < N; ++i) {
      recorded(t - 1, i) = x(i % 2) + 0.01 * std::sin(7.0 * t + i);
      y.push_back({recorded(t - 1, i)});
    }
    if (!sample(agents, t, y, posts)) return 1;
    if (t % 20 != 0) continue;
    double mine[2];
    agents[2]->estimate(mine);
    std::printf("sample %2d: plant %.2f %.2f, agent 2 estimates %.2f %.2f\n", t, x(0), x(1), mine[0],
                mine[1]);
  }

  const Record run = replay(model, network, *filter, recorded, Matrix(), RunOptions{});
  bool same = true;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    double mine[2];
    agents[i]->estimate(mine);
    const double* theirs = run.estimate.data() + (steps * N + i) * 2;
    same = same && mine[0] == theirs[0] && mine[1] == theirs[1];
  }
  std::printf("the bits of a replay: %s\n", same ? "yes" : "no");
}
