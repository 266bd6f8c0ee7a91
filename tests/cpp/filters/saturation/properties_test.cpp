// SPDX-License-Identifier: Apache-2.0
// A search for a violated bound or a false accusation: random systems, graphs, settings and attacks.
#include <doctest/doctest.h>

#include <iostream>

#include "../../random_system.hpp"
#include "garrison/analysis/subsets.hpp"
#include "garrison/attacks/registry.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/saturation/theorems.hpp"
#include "garrison/kernel/chebyshev.hpp"

using namespace garrison;

namespace {

constexpr int kInstances = 2400;
constexpr std::uint64_t kSeed = 20261124;
constexpr int kSteps = 40;
constexpr double kSlack = 1 + 1e-9;

struct Instance {
  Model model;
  Network network;
  ParamMap params;
  std::vector<int> attacked;
  std::vector<Attack> attacks;
  saturation::Setting setting;
  double varpi = kNaN;
  bool detector = false;
  bool adaptive = false;
};

std::vector<int> some_agents(test::Rng& rng, int count, int agents) {
  std::vector<int> all(static_cast<std::size_t>(agents));
  for (int i = 0; i < agents; ++i) all[static_cast<std::size_t>(i)] = i;
  std::shuffle(all.begin(), all.end(), rng);
  all.resize(static_cast<std::size_t>(count));
  return all;
}

Attack random_attack(test::Rng& rng, const Schedule& schedule, int n) {
  const double size = std::pow(10.0, test::uniform(rng, -1, 3));
  switch (test::whole(rng, 0, 9)) {
    case 0:
      return bias(schedule, size);
    case 1:
      return scale(schedule, -size);
    case 2:
      return constant(schedule, kNaN);
    case 3:
      return constant(schedule, -1e300);
    case 4:
      return random_noise(schedule, "cauchy", size, true);
    case 5:
      return ramp(schedule, 0.1 * size);
    case 6:
      return stealthy(schedule, 0.999999);
    case 7:
      return stealthy(schedule, -test::uniform(rng, 0.5, 1.5));
    case 8:
      return false_trajectory(schedule, Vector::Constant(n, size), {});
    default:
      return constant(schedule, kInfinity);
  }
}

/// Draws until a g < 1, so that bounds exist.
Instance draw(std::uint64_t seed) {
  test::Rng rng(seed);
  while (true) {
    const int n = test::whole(rng, 1, 3);
    const int N = test::whole(rng, 3, 10);
    const int s = test::whole(rng, 0, std::max(0, N / 2 - 1));
    const double noise = std::pow(10.0, test::uniform(rng, -3, 0));
    Instance in{test::scalar_model(rng, n, N, test::uniform(rng, 0.5, 1.1), noise,
                                   noise * test::uniform(rng, 0.1, 1)),
                test::connected_network(rng, N, 0.5),
                {},
                {},
                {},
                {}};
    const int L = test::whole(rng, 1, 12);
    const bool chebyshev = test::whole(rng, 0, 3) == 0;
    const auto [lambda2, lambda_max] = in.network.laplacian_spectrum();
    const double gamma = std::max(0.0, (lambda_max - lambda2) / (lambda_max + lambda2));
    const int kind = test::whole(rng, 0, 4);  // 0-1: Algorithm 1, 2-3: Algorithm 2, 4: adaptive
    in.detector = kind == 2 || kind == 3;
    in.adaptive = kind == 4;
    auto& x = in.setting;
    x.agents = N;
    x.a = Eigen::JacobiSVD<Matrix>(in.model.A()).singularValues()(0);
    x.contraction = chebyshev ? chebyshev_contraction(gamma, L) : std::pow(gamma, L);
    x.attacked = s;
    x.eta0 = std::pow(10.0, test::uniform(rng, -1, 1));
    x.b_w = noise;
    x.b_v = in.model.measurement_bound();
    x.beta = x.eta0 * std::pow(10.0, test::uniform(rng, -1.5, 1));
    if (!(x.a * x.contraction < 0.999)) continue;
    x.lambda0 = lambda0(in.model.stacked(), s).lower;
    in.varpi = varpi(in.model.stacked(), in.model.A(), s).upper;
    in.params = {{"rounds", std::int64_t{L}},
                 {"attacked", std::int64_t{s}},
                 {"initial_error", x.eta0},
                 {"chebyshev", chebyshev}};
    if (in.adaptive)
      in.params["adaptive"] = true;
    else
      in.params["threshold"] = x.beta;
    if (in.detector) {
      in.params["detector"] = true;
      in.params["detector_index"] = std::string(kind == 2 ? "t" : "t+1");
    }
    in.attacked = some_agents(rng, s, N);
    if (s > 0 && in.detector) {
      in.attacks = {random_attack(
          rng, Schedule(test::whole(rng, 1, 10), in.attacked, Schedule::kForever, test::uniform(rng, 0.3, 1)),
          n)};
    } else if (s > 0) {  // Algorithm 1: the attacked set may move
      std::vector<Schedule::Phase> phases;
      for (int t = 1; t < kSteps; t += 7) phases.push_back({t, some_agents(rng, s, N)});
      in.attacks = {random_attack(rng, Schedule(phases), n)};
    }
    return in;
  }
}

struct Tally {
  int bounded = 0;
  int proved = 0;
  int feasible = 0;
  int theorem3 = 0;
  double bound = 0.0;
  double p = 0.0;
  double rho = 0.0;
};

/// Disagreement and mean error of one time against p(t) and rho_t.
void check_split(const Record& r, std::size_t t, double p, double rho, Tally& tally) {
  const auto N = static_cast<std::size_t>(r.agents);
  const auto n = static_cast<Eigen::Index>(r.states);
  Matrix x(n, r.agents);
  for (std::size_t i = 0; i < N; ++i)
    x.col(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Vector>(r.estimate.data() + (t * N + i) * static_cast<std::size_t>(n), n);
  const Vector mean = x.rowwise().mean();
  const Vector truth = Eigen::Map<const Vector>(r.truth.data() + t * static_cast<std::size_t>(n), n);
  const double disagreement = (x.colwise() - mean).norm();
  const double error = (mean - truth).norm();
  CHECK(disagreement <= p * kSlack + 1e-12);
  CHECK(error <= rho * kSlack + 1e-12);
  if (p > 0.0) tally.p = std::max(tally.p, disagreement / p);
  tally.rho = std::max(tally.rho, error / rho);
}

void check_theorems(const Instance& in, const Record& r, Tally& tally) {
  const auto bounds = saturation::theorem_bounds(in.setting, in.varpi, kSteps);
  if (!bounds.cond9) return;
  ++tally.feasible;
  tally.theorem3 += bounds.cond12 ? 1 : 0;
  const auto N = static_cast<std::size_t>(r.agents);
  for (std::size_t t = 1; t <= kSteps; ++t)
    for (std::size_t i = 0; i < N; ++i) {
      const double error = r.error[t * N + i];
      CHECK(error <= bounds.thm1_item1[t - 1] * kSlack);
      CHECK(error <= bounds.thm1_item2 * kSlack);
      if (bounds.cond12 && t >= 2) CHECK(error <= bounds.thm3_item2[t - 1] * kSlack);
    }
}

}  // namespace

TEST_CASE("no bound is violated and nobody honest is accused") {
  Tally tally;
  for (int k = 0; k < kInstances; ++k) {
    const std::uint64_t seed = kSeed + static_cast<std::uint64_t>(k);
    CAPTURE(seed);
    const Instance in = draw(seed);
    CAPTURE(in.detector);
    CAPTURE(in.adaptive);
    RunOptions o;
    o.seed = seed;
    o.threads = 1;
    o.attacks = in.attacks;
    o.keep.signals = true;
    const PlantOptions plant{kSteps, {}, in.setting.eta0, k % 2 == 0 ? "extreme" : "uniform"};
    const Record r = simulate(in.model, in.network, *make_filter("saturation", in.params), plant, o);
    const auto N = static_cast<std::size_t>(r.agents);
    for (std::size_t j = 0; j < r.error.size(); ++j) {
      REQUIRE(std::isfinite(r.error[j]));
      if (std::isnan(r.bound[j])) continue;
      ++tally.bounded;
      CHECK(r.error[j] <= r.bound[j] * kSlack);
      tally.bound = std::max(tally.bound, r.error[j] / r.bound[j]);
    }
    for (const auto& accusation : r.accusations)
      for (const auto& set : accusation.sets)
        for (const int agent : set) {
          CHECK(std::find(in.attacked.begin(), in.attacked.end(), agent) != in.attacked.end());
          ++tally.proved;
        }
    if (in.detector) continue;
    const std::size_t S = r.signal_names.size();
    for (std::size_t t = 0; t <= kSteps; ++t)
      check_split(r, t, r.signals[(t * S + 5) * N], r.signals[(t * S + 4) * N], tally);
    if (!in.adaptive) check_theorems(in, r, tally);
  }
  CHECK(tally.proved > 1000);
  CHECK(tally.feasible > 50);
  std::cout << "saturation properties: " << kInstances << " instances from seed " << kSeed << ", "
            << tally.bounded << " bounds checked (largest ratio " << tally.bound << "; p " << tally.p
            << ", rho " << tally.rho << "), " << tally.feasible << " with (9), " << tally.theorem3
            << " with (12), " << tally.proved << " accusations, none violated, none false\n";
}

TEST_CASE("theorem 4: after d sensors are proved, the error settles below its bound") {
  int settled = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Instance in = draw(seed);
    if (!in.detector || in.setting.attacked < 2) continue;
    const auto list = saturation::theorem4(in.setting, 3);
    if (list.empty()) continue;
    // One loud attacker, the others stealthy: d stays below s, so that agents go on testing.
    const std::vector<int> rest(in.attacked.begin() + 1, in.attacked.end());
    in.attacks = {bias(Schedule(2, {in.attacked.front()}), 1e6), stealthy(Schedule(2, rest), 0.9)};
    RunOptions o;
    o.attacks = in.attacks;
    o.threads = 1;
    const PlantOptions plant{400, {}, in.setting.eta0, "extreme"};
    const Record r = simulate(in.model, in.network, *make_filter("saturation", in.params), plant, o);
    if (r.accusations.back().sets.front().size() != 1) continue;
    ++settled;
    CAPTURE(seed);
    const auto N = static_cast<std::size_t>(r.agents);
    for (std::size_t i = 0; i < N; ++i) CHECK(r.error[400 * N + i] <= list[1].tight * (1 + 1e-6));
  }
  CHECK(settled > 3);
}
