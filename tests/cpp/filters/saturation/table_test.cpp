// SPDX-License-Identifier: Apache-2.0
// The data-free table in runs: no error beyond it, nobody accused without cause, whoever is informed and
// whatever is lost.
#include "garrison/certificate/table.hpp"

#include <doctest/doctest.h>

#include "../../random_system.hpp"
#include "by_parts.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/saturation/filter.hpp"

using namespace garrison;

namespace {

struct Counts {
  long bounds = 0;      // of all agents and samples
  long table = 0;       // of these, by the table
  long informed = 0;    // and by theorem I
  long violations = 0;  // of any
  long proofs = 0;      // of attackers
  long false_proofs = 0;
  double closest = 0.0;           // largest error in parts of the table's bound
  double closest_informed = 0.0;  // and of that of theorem I
};

/// What attackers do: as much as they can without being noticed, or not.
Attack random_attack(test::Rng& rng, const Schedule& when, double level) {
  switch (test::whole(rng, 0, 3)) {
    case 0:
      return bias(when, level * test::uniform(rng, 0.1, 1.5));
    case 1:
      return bias(when, -level * std::pow(10.0, test::uniform(rng, -1, 1)));
    case 2:
      return random_noise(when, "uniform", level * test::uniform(rng, 0.1, 4), false);
    default:
      return scale(when, test::uniform(rng, -3, 3));
  }
}

std::vector<int> victims_of(test::Rng& rng, int agents, int s) {
  std::vector<int> all(static_cast<std::size_t>(agents));
  for (int i = 0; i < agents; ++i) all[static_cast<std::size_t>(i)] = i;
  std::shuffle(all.begin(), all.end(), rng);
  all.resize(static_cast<std::size_t>(s));
  std::sort(all.begin(), all.end());
  return all;
}

void count(const Record& r, const std::vector<int>& victims, Counts& c) {
  for (std::size_t k = 0; k < r.bound.size(); ++k) {
    if (!std::isfinite(r.bound[k])) continue;
    ++c.bounds;
    c.violations += r.error[k] > r.bound[k] * (1.0 + 1e-12) ? 1 : 0;
    const double part = r.error[k] / r.bound[k];
    if (r.bound_kind[k] == static_cast<std::uint8_t>(CertificateKind::table)) {
      ++c.table;
      c.closest = std::max(c.closest, part);
    } else if (r.bound_kind[k] == static_cast<std::uint8_t>(CertificateKind::informed)) {
      ++c.informed;
      c.closest_informed = std::max(c.closest_informed, part);
    }
  }
  for (const auto& entry : r.accusations)
    for (const auto& set : entry.sets)
      for (const int id : set)
        ++(std::binary_search(victims.begin(), victims.end(), id) ? c.proofs : c.false_proofs);
}

/// kind 0: detector, 1: fixed threshold, 2: adaptive.
Counts runs(int systems, std::uint64_t seed, int kind) {
  Counts c;
  for (int k = 0; k < systems; ++k) {
    test::Rng rng(seed + static_cast<std::uint64_t>(k));
    const int n = test::whole(rng, 1, 3);
    const int N = test::whole(rng, 4, 8);
    const int s = test::whole(rng, 0, 2);
    const double eta0 = test::uniform(rng, 0.1, 3.0);
    const Model model = test::scalar_model(rng, n, N, test::uniform(rng, 0.5, 1.02), 0.02, 0.05);
    const Network network = test::connected_network(rng, N, 0.6);
    const double beta = test::uniform(rng, 0.1, 3.0);
    ParamMap params{{"rounds", std::int64_t{test::whole(rng, 2, 12)}},
                    {"attacked", std::int64_t{s}},
                    {"initial_error", eta0},
                    {"table", true},
                    {"chebyshev", k % 3 == 0}};
    if (kind == 2) params["adaptive"] = true;
    if (kind != 2) params["threshold"] = beta;
    if (kind == 0) params["detector"] = true;
    RunOptions o;
    o.seed = seed;
    o.threads = 1;
    const std::vector<int> victims = victims_of(rng, N, s);
    if (s > 0) o.attacks = {random_attack(rng, Schedule(test::whole(rng, 1, 12), victims), beta)};
    if (k % 3 == 1) o.link.drop = test::uniform(rng, 0.0, 0.05);
    const PlantOptions plant{30, Vector::Zero(n), 0.999 * eta0, k % 2 == 0 ? "extreme" : "uniform"};
    count(simulate(*make_filter("saturation", params)->prepare(model, network), plant, o), victims, c);
  }
  MESSAGE("kind " << kind << ", seed " << seed << ": " << systems << " systems, " << c.bounds << " bounds, "
                  << c.table << " by the table, " << c.informed << " informed, " << c.violations
                  << " violated, largest error/bound " << c.closest << ", " << c.closest_informed << "; "
                  << c.proofs << " proofs, " << c.false_proofs << " false");
  return c;
}

/// Random systems per kind.
constexpr int kSystems = test::tried(600);

}  // namespace

TEST_CASE("no error beyond the data-free table, and nobody honest is accused by its levels") {
  for (const int kind : {0, 1, 2}) {
    const Counts c = runs(kSystems, 31000, kind);
    CHECK(c.violations == 0);
    CHECK(c.false_proofs == 0);
    CHECK(c.table > 25 * kSystems);
    CHECK(c.closest > 0.5);
    CHECK((kind != 0 || c.proofs > kSystems / 2));
    CHECK((kind == 0 ? c.informed > 5 * kSystems : c.informed == 0));
    CHECK((kind != 0 || c.closest_informed > 0.5));
  }
}

TEST_CASE("a bound outlives the proof of all attackers and gets better, and a lost message ends it") {
  test::Rng rng(5);
  const Model model = test::scalar_model(rng, 2, 6, 0.9, 0.01, 0.02);
  const Network network = Network::complete(6);
  const ParamMap params{{"rounds", std::int64_t{4}}, {"attacked", std::int64_t{1}},
                        {"initial_error", 1.0},      {"threshold", 0.5},
                        {"detector", true},          {"table", true}};
  RunOptions o;
  o.attacks = {bias(Schedule(20, {2}), 50.0)};
  const PlantOptions plant{60, Vector::Zero(2), 0.5};
  const auto prepared = make_filter("saturation", params)->prepare(model, network);
  const Record run = simulate(*prepared, plant, o);
  const auto late = static_cast<std::size_t>(60 * 6);
  CHECK(run.accusations.back().sets[0] == std::vector<int>{2});
  const auto table = static_cast<std::uint8_t>(CertificateKind::table);
  const auto informed = static_cast<std::uint8_t>(CertificateKind::informed);
  CHECK(run.bound_kind[static_cast<std::size_t>(20 * 6)] == table);  // the sample of the proof
  CHECK(run.bound_kind[late] == informed);
  CHECK(run.bound[late] < 0.8 * run.bound[static_cast<std::size_t>(20 * 6)]);
  o.link.drop = 0.2;
  const Record lossy = simulate(*prepared, plant, o);
  CHECK(std::isnan(lossy.bound[late]));
}

TEST_CASE("the levels of the table expose what those of the paper do not see") {
  int found = 0;
  int by_paper = 0;
  int by_table = 0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    test::Rng rng(600 + k);
    const int n = test::whole(rng, 1, 3);
    const Model model = test::scalar_model(rng, n, 8, test::uniform(rng, 0.6, 1.0), 0.01, 0.02);
    const Network network = test::connected_network(rng, 8, 0.6);
    ParamMap params{{"rounds", std::int64_t{test::whole(rng, 5, 30)}},
                    {"attacked", std::int64_t{2}},
                    {"initial_error", 1.0},
                    {"threshold", test::uniform(rng, 0.1, 2.0)},
                    {"detector", true}};
    RunOptions o;
    const auto run = [&](bool table) {
      params["table"] = table;
      return simulate(*make_filter("saturation", params)->prepare(model, network),
                      {60, Vector::Zero(n), 0.1, "none"}, o);
    };
    const std::size_t last = 60 * 8 + 2;  // agent 2
    const double papers = run(false).threshold[last];
    const double tables = run(true).threshold[last];
    CHECK(tables <= papers);
    if (tables > 0.8 * papers) continue;
    ++found;
    o.attacks = {bias(Schedule(40, {2}), 0.5 * (papers + tables))};
    by_paper += run(false).accusations.back().sets[0].empty() ? 0 : 1;
    by_table += run(true).accusations.back().sets[0] == std::vector<int>{2} ? 1 : 0;
  }
  CHECK(found > 10);
  CHECK(by_paper == 0);
  CHECK(by_table == found);
}

TEST_CASE("agents driven by bytes read the table as the engine does, from a part of a design") {
  test::Rng rng(7);
  const Model model = test::scalar_model(rng, 2, 5, 0.9, 0.01, 0.02);
  const Network network = test::connected_network(rng, 5);
  for (const bool adaptive : {false, true}) {
    ParamMap params{{"rounds", std::int64_t{5}},
                    {"attacked", std::int64_t{1}},
                    {"initial_error", 1.0},
                    {"table", true},
                    {"adaptive", adaptive}};
    if (!adaptive) params.insert({{"threshold", 0.5}, {"detector", true}});
    const auto prepared = make_filter("saturation", params)->prepare(model, network);
    const Record run = test::run_by_parts(*prepared, 200);
    const auto informed = static_cast<std::uint8_t>(CertificateKind::informed);
    CHECK((run.bound_kind[static_cast<std::size_t>(5 * 200)] == informed) == !adaptive);
  }
}

TEST_CASE("the averaging of the table is that of the filter's rounds") {
  test::Rng rng(8);
  const Model model(Matrix::Identity(1, 1), std::vector<Matrix>(6, Matrix(0, 1)));
  const Network network = test::connected_network(rng, 6);
  for (const bool chebyshev : {false, true}) {
    const auto gains = Saturation::design({{.rounds = 7, .chebyshev = chebyshev}, 0.5}, model, network);
    const Matrix J = saturation::averaging(network, gains.alpha, gains.omega, 7);
    RunOptions o;
    o.start = test::normal_matrix(rng, 1, 6);
    const auto filter = make_filter(
        "saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{7}}, {"chebyshev", chebyshev}});
    const Record run = replay(model, network, *filter, Matrix(1, 0), Matrix(), o);
    for (int i = 0; i < 6; ++i)
      CHECK(run.estimate[static_cast<std::size_t>(6 + i)] ==
            doctest::Approx((J.row(i) * o.start.transpose())(0)).epsilon(1e-12));
  }
}

TEST_CASE("a table that cannot be made is refused by name") {
  const Network network = Network::complete(4);
  const Model model(Matrix::Identity(1, 1), std::vector<Matrix>(4, Matrix::Ones(1, 1)),
                    {0.1, Vector::Constant(4, 0.1), {}, {}});
  CHECK_THROWS_WITH_AS(
      make_filter("saturation", {{"threshold", 0.5}, {"table", true}})->prepare(model, network),
      doctest::Contains("saturation.table: got true"), InvalidInput);
  const int many = 401;
  const Model large(Matrix::Identity(1, 1), std::vector<Matrix>(many, Matrix::Ones(1, 1)),
                    {0.1, Vector::Constant(many, 0.1), {}, {}});
  CHECK_THROWS_WITH_AS(
      make_filter("saturation", {{"threshold", 0.5}, {"table", true}, {"initial_error", 1.0}})
          ->prepare(large, Network::complete(many)),
      doctest::Contains("at most 400"), InvalidInput);
}
