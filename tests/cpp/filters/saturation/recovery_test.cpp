// SPDX-License-Identifier: Apache-2.0
// Recovery after lost messages (theorem L) in the filter itself: no error beyond a bound and nobody honest
// accused or clipped, whatever is lost and whatever attackers and noise do; and bounds come back.
#include <doctest/doctest.h>

#include <cstring>

#include "../../agents_by_hand.hpp"
#include "garrison/drivers/simulate.hpp"
#include "worst_case.hpp"

using namespace garrison;
using test::Counts;
using test::Kind;
using test::Worst;

namespace {

template <int n>
Counts one(test::Rng& rng, Kind kind, bool chebyshev) {
  const int N = test::whole(rng, 4, 8);
  const int s = test::whole(rng, 0, 2);
  const double noise = std::pow(10.0, test::uniform(rng, -2.0, 0.0));
  const double eta0 = test::uniform(rng, 0.1, 3.0);
  const Model model = test::scalar_model(rng, n, N, test::uniform(rng, 0.5, 1.03),
                                         noise * test::uniform(rng, 0.0, 1.0), noise);
  const Network network = test::connected_network(rng, N, 0.6);
  Saturation::Params p;
  p.rounds = test::whole(rng, 1, 10);
  p.chebyshev = chebyshev;
  p.attacked = s;
  p.initial_error = eta0;
  p.detector = kind == Kind::detector;
  p.adaptive = kind == Kind::adaptive;
  if (kind != Kind::adaptive) p.threshold = test::uniform(rng, 0.3, 3.0);
  p.table = p.recovery = true;
  Worst<n> worst(rng, model, network, Saturation::design(p, model, network), s, test::whole(rng, 8, 25));
  return worst.run(kind, 90, eta0, test::uniform(rng, 0.02, 0.4));
}

/// Random systems per kind.
constexpr int kSystems = test::tried(200);

Counts runs(Kind kind, std::uint64_t seed) {
  Counts all;
  for (int k = 0; k < kSystems; ++k) {
    test::Rng rng(seed + static_cast<std::uint64_t>(k));
    const bool chebyshev = k % 3 == 0;
    const Counts c = k % 2 == 0   ? one<2>(rng, kind, chebyshev)
                     : k % 4 == 1 ? one<1>(rng, kind, chebyshev)
                                  : one<3>(rng, kind, chebyshev);
    all.bounds += c.bounds;
    all.recovered += c.recovered;
    all.violations += c.violations;
    all.proofs += c.proofs;
    all.false_proofs += c.false_proofs;
    all.clipped += c.clipped;
    all.decaying += c.decaying;
    all.back += c.back;
    all.closest = std::max(all.closest, c.closest);
  }
  MESSAGE("kind " << static_cast<int>(kind) << ", seed " << seed << ": " << kSystems << " systems, "
                  << all.bounds << " bounds, " << all.recovered << " recovered, " << all.violations
                  << " violated, largest error/bound " << all.closest << "; " << all.proofs << " proofs, "
                  << all.false_proofs << " false; " << all.clipped << " honest clipped; " << all.back
                  << " of " << all.decaying << " networks back at twice the table");
  return all;
}

ParamMap parameters(bool adaptive, bool recovery) {
  ParamMap params{{"rounds", std::int64_t{4}}, {"attacked", std::int64_t{1}},
                  {"initial_error", 1.0},      {"table", true},
                  {"adaptive", adaptive},      {"recovery", recovery}};
  if (!adaptive) params.insert({{"threshold", 0.5}, {"detector", true}});
  return params;
}

/// One of the bounds of a record.
double bound(const Record& r, int t, int i, int agents) {
  return r.bound[static_cast<std::size_t>(t * agents + i)];
}

}  // namespace

TEST_CASE("L: through losses and after them no error is beyond its bound, and nobody honest is accused") {
  for (const Kind kind : {Kind::detector, Kind::fixed, Kind::adaptive}) {
    const Counts c = runs(kind, 52000 + 1000 * static_cast<std::uint64_t>(kind));
    CHECK(c.violations == 0);
    CHECK(c.false_proofs == 0);
    CHECK(c.clipped == 0);
    CHECK(c.recovered > 100 * kSystems);
    CHECK(c.closest > 0.5);
    CHECK(c.decaying > kSystems / 4);
    CHECK(c.back > 0.9 * c.decaying);
    CHECK((kind != Kind::detector || c.proofs > kSystems));
  }
}

TEST_CASE("L: a lossless run costs no byte and no bit") {
  test::Rng rng(11);
  const Model model = test::scalar_model(rng, 2, 6, 0.9, 0.01, 0.02);
  const Network network = Network::complete(6);
  RunOptions o;
  o.attacks = {bias(Schedule(20, {2}), 0.3)};
  for (const bool adaptive : {false, true}) {
    const auto run = [&](bool recovery) {
      return simulate(*make_filter("saturation", parameters(adaptive, recovery))->prepare(model, network),
                      {60, Vector::Zero(2), 0.5}, o);
    };
    const Record with = run(true);
    const Record without = run(false);
    CHECK(with.bytes_per_step == without.bytes_per_step);
    CHECK(with.estimate == without.estimate);
    CHECK(with.bound == without.bound);
    CHECK(with.bound_kind == without.bound_kind);
  }
}

TEST_CASE("L: one lost message, and the bound fades back to the table's while the detector goes on") {
  test::Rng rng(12);
  const Model model = test::scalar_model(rng, 2, 6, 0.9, 0.01, 0.02);
  const Network network = Network::complete(6);
  const auto prepared = make_filter("saturation", parameters(false, true))->prepare(model, network);
  RunOptions o;
  o.link.lost = {{{1, 20, 0}, 0}};  // from 1 to 0, in the first round of sample 20
  o.attacks = {bias(Schedule(40, {2}), 50.0)};
  const Record run = simulate(*prepared, {80, Vector::Zero(2), 0.5}, o);
  const auto recovered = static_cast<std::uint8_t>(CertificateKind::recovered);
  CHECK(run.bound_kind[20 * 6] == recovered);
  CHECK(bound(run, 20, 0, 6) > bound(run, 19, 0, 6));
  for (int t = 21; t <= 80; ++t)
    for (int i = 0; i < 6; ++i) CHECK(run.bound_kind[static_cast<std::size_t>(6 * t + i)] == recovered);
  CHECK(bound(run, 80, 0, 6) < 1.01 * bound(run, 19, 0, 6));
  CHECK(run.accusations.back().sets[0] == std::vector<int>{2});
  CHECK(run.accusations.back().sets[3] == std::vector<int>{2});
}

TEST_CASE("L: agents of bytes behind losses, restarted from a snapshot, have the bits of the engine") {
  test::Rng rng(14);
  const Model model = test::scalar_model(rng, 2, 5, 0.9, 0.01, 0.02);
  const Network network = test::connected_network(rng, 5);
  for (const bool adaptive : {false, true}) {
    const auto prepared = make_filter("saturation", parameters(adaptive, true))->prepare(model, network);
    RunOptions o;
    o.attacks = {bias(Schedule(10, {3}), 0.6)};
    o.link.drop = 0.02;
    const Record run = simulate(*prepared, {100, Vector::Zero(2), 0.5}, o);
    const Link link(network, o.link, {}, o.seed, 0);
    test::AgentsByHand agents(*prepared, network, &link);
    for (int i = 0; i < 5; ++i)
      REQUIRE(agents[i].reset(Vector(Eigen::Map<const Vector>(run.estimate.data() + 2 * i, 2))) ==
              Refusal::none);
    int recovered = 0;
    for (int t = 1; t <= 100; ++t) {
      agents.step(t, [&](int i) {
        return Vector::Constant(1, run.measurements[static_cast<std::size_t>(5 * (t - 1) + i)]);
      });
      for (int i = 0; i < 5; ++i) {
        std::vector<std::byte> snapshot(agents[i].snapshot_bytes());
        REQUIRE(agents[i].save(snapshot) == snapshot.size());
        agents.all()[static_cast<std::size_t>(i)] = prepared->agent(i);
        REQUIRE(agents[i].load(snapshot) == Refusal::none);
        const Report report = agents[i].report();
        const auto at = static_cast<std::size_t>(5 * t + i);
        REQUIRE(std::memcmp(&report.bound, &run.bound[at], sizeof(double)) == 0);
        REQUIRE(static_cast<std::uint8_t>(report.kind) == run.bound_kind[at]);
        REQUIRE(std::memcmp(&report.threshold, &run.threshold[at], sizeof(double)) == 0);
        recovered += report.kind == CertificateKind::recovered ? 1 : 0;
      }
    }
    CHECK(recovered > 200);
  }
}

TEST_CASE("L: an agent that was away has a bound again soon after it joins, and so have the others") {
  test::Rng rng(13);
  const Model model = test::scalar_model(rng, 2, 5, 0.9, 0.01, 0.02);
  const Network network = Network::complete(5);
  for (const bool adaptive : {false, true}) {
    const auto prepared = make_filter("saturation", parameters(adaptive, true))->prepare(model, network);
    test::AgentsByHand agents(*prepared, network);
    const auto y = [&](int i) { return Vector(model.C(i) * Vector::Zero(2)); };
    for (int t = 1; t <= 60; ++t) {
      agents.step(t, y, t > 20 && t <= 25 ? 3 : -1);
      if (t > 20 && t <= 25) continue;
      for (int i = 0; i < 5; ++i) {
        CAPTURE(t);
        CAPTURE(i);
        const Report report = agents[i].report();
        Vector x(2);
        agents[i].estimate({x.data(), 2});
        CHECK(x.norm() <= report.bound);
        CHECK(std::isfinite(report.bound));
        CHECK((report.kind == CertificateKind::recovered) == (t > 25));
      }
    }
  }
}

TEST_CASE("L: what nobody could say counts as nothing known") {
  saturation::LossNote note;
  CHECK(!note.kept());
  note.keep();
  CHECK(note.whole());
  saturation::LossRecord r;
  r.state = {90, 2.0};
  r.bound = 3.0;
  note.say(r, 100);
  CHECK(!note.whole());
  CHECK(note.state(100) == certificate::LossState{90, 2.0});
  CHECK(note.bound() == 3.0);
  CHECK(!note.lost());
  const saturation::LossNote copy = note;
  r.lost = true;
  r.state.x = kInfinity;
  r.bound = kInfinity;
  note.say(r, 100);
  CHECK(note.lost());
  CHECK(note.state(100).x == kInfinity);
  CHECK(note.bound() == kInfinity);
  CHECK(copy.bound() == 3.0);
  const auto told = [&](double age, double x) {
    struct Write {
      double age, x;
      void sparse(std::string_view, std::array<double, 4>& v) {
        v[0] = age;
        v[1] = x;
      }
    } write{age, x};
    note.visit(write);
    return note.state(100);
  };
  CHECK(told(3.0, 1.0) == certificate::LossState{96, 1.0});
  for (const auto& [age, x] : {std::pair{-1.0, 1.0}, {2.5, 1.0}, {100.0, 1.0}, {513.0, 1.0}, {3.0, -1.0}})
    CHECK(told(age, x) == certificate::LossState{99, kInfinity});
}

TEST_CASE("L: it goes on from a table, and a design says so") {
  const Network network = Network::complete(4);
  const Model model(Matrix::Identity(1, 1), std::vector<Matrix>(4, Matrix::Ones(1, 1)),
                    {0.1, Vector::Constant(4, 0.1), {}, {}});
  CHECK_THROWS_WITH_AS(
      make_filter("saturation", {{"threshold", 0.5}, {"recovery", true}, {"initial_error", 1.0}})
          ->prepare(model, network),
      doctest::Contains("saturation.recovery: got true"), InvalidInput);
}
