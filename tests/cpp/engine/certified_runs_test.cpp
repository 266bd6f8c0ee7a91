// SPDX-License-Identifier: Apache-2.0
// Certified runs of all families on random systems, graphs, losses and attacks: no error beyond its bound.
#include <doctest/doctest.h>

#include "../every_filter.hpp"
#include "../random_system.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;
using certificate::Spread;
using certificate::Wanted;

namespace {

struct Counts {
  long bounds = 0;
  long violations = 0;
  long refuted = 0;
  long none = 0;
  double closest = 0.0;        // largest error in parts of its bound, of those below 1
  std::vector<double> failed;  // per system: share of bounds that are violated, or refuted without cause

  /// Mean share, at most so much with 99 % confidence: systems are independent of each other.
  double share() const {
    double sum = 0.0;
    double squares = 0.0;
    for (const double f : failed) {
      sum += f;
      squares += f * f;
    }
    const auto systems = static_cast<double>(failed.size());
    const double mean = sum / systems;
    return mean + 2.33 * std::sqrt(std::max(0.0, squares / systems - mean * mean) / systems);
  }
};

/// Attacks on s sensors at a time, other ones in every stretch of six samples.
std::vector<Attack> moving_attacks(test::Rng& rng, int agents, int s, int samples) {
  std::vector<Attack> attacks;
  for (int start = 1; start <= samples; start += 6) {
    std::vector<int> all(static_cast<std::size_t>(agents));
    for (int i = 0; i < agents; ++i) all[static_cast<std::size_t>(i)] = i;
    std::shuffle(all.begin(), all.end(), rng);
    all.resize(static_cast<std::size_t>(s));
    if (all.empty()) continue;
    std::sort(all.begin(), all.end());
    const Schedule when(start, all, start + 6);
    switch (test::whole(rng, 0, 4)) {
      case 0:
        attacks.push_back(bias(when, std::pow(10.0, test::uniform(rng, -2, 2))));
        break;
      case 1:
        attacks.push_back(scale(when, test::uniform(rng, -4, 4)));
        break;
      case 2:
        attacks.push_back(random_noise(when, "normal", std::pow(10.0, test::uniform(rng, -2, 1)), false));
        break;
      case 3:
        attacks.push_back(constant(when, 1e8));
        break;
      default:
        attacks.push_back(denial(when));
    }
  }
  return attacks;
}

std::vector<int> all_of(int agents) {
  std::vector<int> all(static_cast<std::size_t>(agents));
  for (int i = 0; i < agents; ++i) all[static_cast<std::size_t>(i)] = i;
  return all;
}

Counts certified_runs(int systems, std::uint64_t seed, double failure, const std::string& noise) {
  Counts counts;
  const auto filters = test::every_filter(false);
  for (int k = 0; k < systems; ++k) {
    test::Rng rng(seed + static_cast<std::uint64_t>(k));
    const int n = test::whole(rng, 1, 3);
    const int N = test::whole(rng, 4, 8);
    const int s = test::whole(rng, 0, 2);
    const int samples = 24;
    const Model model = test::scalar_model(rng, n, N, test::uniform(rng, 0.6, 1.0), 0.02, 0.05);
    const Network network = test::connected_network(rng, N);
    const auto& filter = filters[static_cast<std::size_t>(k) % filters.size()];
    const Wanted wanted{static_cast<Spread>(k % 3), failure, s, k % 5 == 0 ? 0 : 1000};
    RunOptions o;
    o.seed = seed;
    o.threads = 1;
    o.attacks = moving_attacks(rng, N, s, samples);
    if (k % 4 != 0) o.link.drop = test::uniform(rng, 0.0, 0.8);
    // Whatever agents say of their estimates: the bound is on what each makes of it.
    if (wanted.spread == Spread::direct && s > 0 && k % 2 == 0)
      o.message_attacks = {forge(Schedule(1, all_of(N)), test::uniform(rng, 0.1, 10.0), false)};
    const PlantOptions plant{samples, Vector::Constant(n, 3.0), 1.0,
                             k % 5 == 0 && failure == 0.0 ? "extreme" : noise};
    const Record r = simulate(*certified(*filter->prepare(model, network), wanted), plant, o);
    const long before = counts.violations + counts.refuted;
    for (std::size_t at = static_cast<std::size_t>(N); at < r.bound.size(); ++at) {
      const double bound = r.bound[at];
      counts.refuted += std::isnan(bound) ? 1 : 0;
      counts.none += std::isinf(bound) ? 1 : 0;
      if (!std::isfinite(bound)) continue;
      ++counts.bounds;
      counts.violations += r.error[at] > bound * (1.0 + 1e-12) ? 1 : 0;
      if (bound < 1.0) counts.closest = std::max(counts.closest, r.error[at] / bound);
    }
    counts.failed.push_back(static_cast<double>(counts.violations + counts.refuted - before) /
                            static_cast<double>(samples * N));
  }
  MESSAGE("failure " << failure << ", seed " << seed << ": " << systems << " systems, " << counts.bounds
                     << " bounds, " << counts.none << " without one, " << counts.violations << " violated, "
                     << counts.refuted << " refuted, largest error/bound " << counts.closest
                     << ", failed at most " << counts.share() << " (99 %)");
  return counts;
}

}  // namespace

TEST_CASE("deterministic certificates of all families hold, whatever is attacked and lost") {
  const Counts c = certified_runs(2000, 7000, 0.0, "uniform");
  CHECK(c.violations == 0);
  CHECK(c.refuted == 0);  // never more than s are attacked
  CHECK(c.bounds > 50000);
  CHECK(c.closest > 0.5);
}

TEST_CASE("Gaussian certificates of all families fail more rarely than they promise") {
  for (const double failure : {0.05, 1e-6}) {
    const Counts c = certified_runs(1000, 17000, failure, "normal");
    CHECK(c.share() <= failure);
    CHECK(c.bounds > 20000);
    CHECK(c.closest > 0.1);
  }
}
