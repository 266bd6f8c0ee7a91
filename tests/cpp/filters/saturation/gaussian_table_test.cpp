// SPDX-License-Identifier: Apache-2.0
// The table for Gaussian noise (theorem TG) in the filter itself: a whole run is false with the probability
// that was asked for at most.
#include <doctest/doctest.h>

#include "by_parts.hpp"
#include "garrison/certificate/quantiles.hpp"
#include "garrison/drivers/simulate.hpp"
#include "worst_case.hpp"

using namespace garrison;
using test::Counts;
using test::Kind;
using test::Worst;

namespace {

constexpr int kHorizon = 40;

template <int n>
Counts one(test::Rng& rng, Kind kind, double failure) {
  const int N = test::whole(rng, 4, 8);
  const int s = test::whole(rng, 0, 2);
  const double eta0 = test::uniform(rng, 0.1, 3.0);
  const Model bounded = test::scalar_model(rng, n, N, test::uniform(rng, 0.5, 1.02), 0.0, 0.0);
  const Matrix root = 0.1 * test::normal_matrix(rng, n, n) + 0.02 * Matrix::Identity(n, n);
  Noise noise;
  noise.process_covariance = root * root.transpose();
  std::vector<Matrix> C;
  for (int i = 0; i < N; ++i) {
    C.push_back(bounded.C(i));
    noise.measurement_covariance.push_back(
        Matrix::Constant(1, 1, std::pow(10.0, test::uniform(rng, -4.0, -1.0))));
  }
  const Model model(bounded.A(), C, noise);
  const Network network = test::connected_network(rng, N, 0.6);
  Saturation::Params p;
  p.rounds = test::whole(rng, 1, 10);
  p.chebyshev = test::whole(rng, 0, 2) == 0;
  p.attacked = s;
  p.initial_error = eta0;
  p.detector = kind == Kind::detector;
  p.threshold = test::uniform(rng, 0.3, 3.0);
  p.table = true;
  p.failure = failure;
  p.horizon = kHorizon;
  Worst<n> worst(rng, model, network, Saturation::design(p, model, network), s, test::whole(rng, 8, 25));
  return worst.run(kind, kHorizon + 5, eta0, 0.0);
}

/// Random systems.
constexpr int kSystems = test::tried(200);

Counts runs(Kind kind, double failure, std::uint64_t seed) {
  Counts all;
  for (int k = 0; k < kSystems; ++k) {
    test::Rng rng(seed + static_cast<std::uint64_t>(k));
    const Counts c = k % 2 == 0   ? one<2>(rng, kind, failure)
                     : k % 4 == 1 ? one<1>(rng, kind, failure)
                                  : one<3>(rng, kind, failure);
    all.bounds += c.bounds;
    all.violations += c.violations;
    all.proofs += c.proofs;
    all.false_proofs += c.false_proofs;
    all.wrong += c.wrong;
    all.closest = std::max(all.closest, c.closest);
  }
  MESSAGE("kind " << static_cast<int>(kind) << ", failure " << failure << ", seed " << seed << ": "
                  << kSystems << " systems, " << all.bounds << " bounds, " << all.violations
                  << " violated, largest error/bound " << all.closest << "; " << all.proofs << " proofs, "
                  << all.false_proofs << " false; " << all.wrong << " runs with something false");
  return all;
}

Model gaussian_model(int agents) {
  test::Rng rng(21);
  const Model with = test::scalar_model(rng, 2, agents, 0.9, 0.01, 0.02);
  std::vector<Matrix> C;
  for (int i = 0; i < agents; ++i) C.push_back(with.C(i));
  Noise noise;
  noise.process_covariance = 1e-4 * Matrix::Identity(2, 2);
  noise.measurement_covariance.assign(static_cast<std::size_t>(agents), Matrix::Constant(1, 1, 1e-3));
  return {with.A(), C, noise};
}
ParamMap parameters(bool detector) {
  return {{"rounds", std::int64_t{4}}, {"attacked", std::int64_t{1}}, {"initial_error", 1.0},
          {"threshold", 0.5},          {"detector", detector},        {"table", true},
          {"failure", 1e-3},           {"horizon", std::int64_t{50}}};
}

}  // namespace

TEST_CASE("TG: no more runs have anything false in them than were allowed") {
  for (const Kind kind : {Kind::detector, Kind::fixed}) {
    const Counts rare = runs(kind, 1e-6, 71000);
    CHECK(rare.wrong == 0);
    CHECK(rare.bounds > 50 * kSystems);
    CHECK((kind != Kind::detector || rare.proofs > kSystems));
    const Counts often = runs(kind, 0.5, 72000);
    CHECK(often.wrong < 0.5 * kSystems);
    CHECK(often.closest > 0.5);
  }
}

TEST_CASE("TG: bounds up to the horizon and none beyond, for noise of which only covariances are known") {
  const Model model = gaussian_model(6);
  const Network network = Network::complete(6);
  for (const bool detector : {false, true}) {
    const auto prepared = make_filter("saturation", parameters(detector))->prepare(model, network);
    RunOptions o;
    o.attacks = {bias(Schedule(20, {2}), 50.0)};
    const Record run = simulate(*prepared, {60, Vector::Zero(2), 0.5}, o);
    const auto table = static_cast<std::uint8_t>(CertificateKind::table);
    for (int t = 1; t <= 60; ++t)
      for (int i = 0; i < 6; ++i) {
        const auto k = static_cast<std::size_t>(6 * t + i);
        CHECK(std::isfinite(run.bound[k]) == (t <= 50));
        if (t <= 50) CHECK(run.error[k] <= run.bound[k]);
        if (t <= 50) CHECK(run.bound_kind[k] == table);
        if (t > 50 && i != 2 && !detector)
          CHECK(run.verdict[k] != static_cast<std::uint8_t>(Verdict::attacked));
      }
    CHECK((run.accusations.empty() || run.accusations.back().sets[0].empty()) == !detector);
  }
}

TEST_CASE("TG: agents driven by bytes have the bits of the engine, from a part of a design") {
  const Model model = gaussian_model(5);
  const Network network = Network::ring(5);
  test::run_by_parts(*make_filter("saturation", parameters(true))->prepare(model, network), 60);
}

TEST_CASE("TG: check prints what holds to the end, and what does not go together is refused by name") {
  const Model model = gaussian_model(6);
  const Network network = Network::complete(6);
  const auto check = [&](const ParamMap& params) {
    return make_filter("saturation", params)->check(model, network);
  };
  const Check c = check(parameters(true));
  const auto bound = std::find_if(c.quantities.begin(), c.quantities.end(),
                                  [](const Quantity& q) { return q.name == "table bound"; });
  REQUIRE(bound != c.quantities.end());
  const auto prepared = make_filter("saturation", parameters(true))->prepare(model, network);
  const Record run = simulate(*prepared, {50, Vector::Zero(2), 0.5}, {});
  CHECK(bound->value ==
        doctest::Approx(*std::max_element(run.bound.end() - 6, run.bound.end())).epsilon(0.01));
  CHECK(bound->meaning.find("to 50, theorem TG") != std::string::npos);
  const auto refused = [&](const char* name, const ParamValue& value, const char* said) {
    ParamMap params = parameters(false);
    params.insert_or_assign(name, value);
    CHECK_THROWS_WITH_AS(make_filter("saturation", params)->prepare(model, network), doctest::Contains(said),
                         InvalidInput);
  };
  refused("failure", 0.0, "saturation.failure: got 0");
  refused("failure", 1.0, "saturation.failure: got 1");
  refused("horizon", std::int64_t{0}, "saturation.horizon: got 0");
  refused("table", false, "saturation.failure: got 0.001");
  refused("recovery", true, "saturation.recovery: got true");
  test::Rng rng(3);
  const Model other(model.A(), std::vector<Matrix>(6, Matrix::Identity(1, 2)),
                    {0.1, Vector::Ones(6), {}, {}});
  CHECK_THROWS_WITH_AS(make_filter("saturation", parameters(false))->prepare(other, network),
                       doctest::Contains("no process_covariance"), InvalidInput);
}
