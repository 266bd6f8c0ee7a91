// SPDX-License-Identifier: Apache-2.0
// Vehicles that are replaced while the string drives.
#include <doctest/doctest.h>

#include <cstring>

#include "../../agents_by_hand.hpp"
#include "string_by_hand.hpp"

using namespace garrison;

namespace {

constexpr int kStop = 100;
constexpr int kEnd = 300;

/// A string that starts in formation, with random sizes; its vehicles know where they are to within q = 3.
struct Road {
  test::Platoon p;
  test::Start start;
};
Road road(test::Rng& rng) {
  const int L = test::whole(rng, 1, 3);
  const int N = test::whole(rng, std::max(3, 2 * L + 1), 10);
  platoon::Setting s;
  s.vehicles = N;
  s.range = L;
  s.attacked = test::whole(rng, 1, L);
  s.period = 0.1;
  s.eps = 0.01;
  s.mu = 0.02;
  s.q = 3.0;
  ParamMap params{{"attacked", std::int64_t{s.attacked}},
                  {"process_noise", s.eps},
                  {"measurement_noise", s.mu},
                  {"initial_error", s.q},
                  {"gs", 0.5},
                  {"gv", 1.0},
                  {"spacing", 20.0},
                  {"reference", std::vector<double>{0.0, 10.0}}};
  Road r{{s, params, platoon::model(N, s.period), Network::band(N, L)}, {Vector(2 * N), Matrix(2, N)}};
  for (int i = 0; i < N; ++i) {
    r.start.x0(2 * i) = r.start.estimate(0, i) = -20.0 * i;
    r.start.x0(2 * i + 1) = r.start.estimate(1, i) = 10.0;
    for (int k = 0; k < 2; ++k) r.start.estimate(k, i) += test::uniform(rng, -1, 1);
  }
  return r;
}

/// The promises of a whole run, and the largest error of `who` from 50 samples after kStop on.
struct Outcome {
  test::Promises kept;
  double error = 0.0;
  int without_bound = 0;  // samples of vehicles, from 50 after kStop on
  int widened = 0;        // samples with a bound of twice what it was before, anywhere
};
struct Disturbance {
  int who = -1;  // is replaced after sample kStop; -1: nobody
  Vec<2> x0 = Vec<2>::Zero();
  double loss = 0.0;
};
Outcome drive(const Road& r, const ParamMap& params, const Disturbance& d, int watched,
              const std::vector<int>& victims, const std::vector<Attack>& attacks, std::uint64_t seed) {
  test::StringByHand string(r.p, params, r.start, seed, "uniform");
  string.attack(attacks);
  Outcome o;
  std::vector<double> before(static_cast<std::size_t>(string.N()), 0.0);
  for (int t = 0; t <= kEnd; ++t) {
    string.step(t, d.loss);
    string.judge(victims, o.kept);
    for (int i = 0; i < string.N(); ++i) {
      double& usual = before[static_cast<std::size_t>(i)];
      if (t > kStop - 50 && t <= kStop) usual = std::max(usual, string.bound(i));
      if (t < kStop + 50) continue;
      if (std::isnan(string.bound(i))) ++o.without_bound;
      if (!(string.bound(i) <= 2.0 * usual)) ++o.widened;
    }
    if (t >= kStop + 50) o.error = std::max(o.error, string.error(watched));
    if (t == kStop && d.who >= 0) string.replace(d.who, d.x0);
  }
  return o;
}

void check_kept(const test::Promises& p) {
  CHECK(p.bounds_violated == 0);
  CHECK(p.gaps_violated == 0);
  CHECK(p.accused_clean == 0);
  CHECK(p.cleared_attacked == 0);
  CHECK(p.doubted == 0);
}

}  // namespace

TEST_CASE(
    "a vehicle that is replaced, wherever it drives and whatever it is told, comes back safely: 120 "
    "strings") {
  test::Rng rng(31);
  for (int run = 0; run < 120; ++run) {
    const Road r = road(rng);
    const int N = r.p.setting.vehicles;
    const int who = run % 3 == 0 ? 0 : run % 3 == 1 ? N - 1 : test::whole(rng, 1, N - 2);
    const auto victims = run % 2 == 0 ? std::vector<int>{} : test::random_victims(rng, r.p.setting);
    const auto attacks = test::random_attack(rng, r.p.setting, victims);
    ParamMap params = r.p.params;
    if (run % 4 >= 2)
      for (const char* name : {"pairs", "neighbours", "median"}) params[name] = true;
    const auto seed = static_cast<std::uint64_t>(run);
    const Outcome usual = drive(r, params, {}, who, victims, attacks, seed);
    Disturbance d{who, {r.start.x0(2 * who) + 10.0 * 0.1 * kStop, 10.0}, 0.0};
    if (run % 5 == 1) d.x0.setZero();            // knows nothing
    if (run % 5 == 2) d.x0 = Vec<2>(-1e6, 1e4);  // or is told nonsense
    CAPTURE(run);
    CAPTURE(N);
    CAPTURE(who);
    const Outcome o = drive(r, params, d, who, victims, attacks, seed);
    check_kept(usual.kept);
    check_kept(o.kept);
    CHECK(o.error <= 2.0 * usual.error);
    CHECK(o.without_bound <= usual.without_bound);
    CHECK(o.widened <= usual.widened);
    CHECK(o.kept.least_gap > 10.0);
    // And where half of the messages are lost.
    d.loss = 0.5;
    const Outcome lossy = drive(r, params, d, who, victims, attacks, seed);
    check_kept(lossy.kept);
    CHECK(lossy.kept.least_gap > 5.0);
  }
}

TEST_CASE("a replaced vehicle comes back driven by bytes, with what it last knew or nothing") {
  test::Rng rng(32);
  for (int run = 0; run < 6; ++run) {
    const Road r = road(rng);
    const int N = r.p.setting.vehicles;
    const int who = run % 3 == 0 ? 0 : run % 3 == 1 ? N - 1 : N / 2;
    const auto filter = make_filter("platoon", r.p.params);
    const auto prepared = filter->prepare(r.p.model, r.p.network);
    double worst[2] = {0.0, 0.0};
    for (const bool replaced : {false, true}) {
      test::AgentsByHand agents(*prepared, r.p.network);
      for (int i = 0; i < N; ++i) agents[i].reset(r.start.estimate.col(i));
      const auto world = prepared->world({r.start.x0, r.start.estimate, 0.0, "uniform", nullptr, 7, 0});
      std::vector<double> u(static_cast<std::size_t>(N), 0.0);
      std::vector<double> y(static_cast<std::size_t>(r.p.model.total_outputs()));
      double least = kInfinity;
      for (int t = 0; t <= kEnd; ++t) {
        world->next(t, u, y);
        agents.step(t, [&](int i) {
          return Vector(Eigen::Map<const Vector>(y.data() + r.p.model.offset(i), r.p.model.outputs(i)));
        });
        for (int i = 0; i < N; ++i) u[static_cast<std::size_t>(i)] = agents[i].control();
        const auto x = world->truth();
        for (int i = 1; i < N; ++i)
          least =
              std::min(least, x[static_cast<std::size_t>(2 * i - 2)] - x[static_cast<std::size_t>(2 * i)]);
        for (int i = 0; i < N; ++i) {
          double e[2];
          agents[i].estimate(e);
          const double error = platoon::length(e[0] - x[static_cast<std::size_t>(2 * i)],
                                               e[1] - x[static_cast<std::size_t>(2 * i + 1)]);
          CHECK_FALSE(error > agents[i].report().bound);
          if (i == who && t >= kStop + 50) worst[replaced ? 1 : 0] = std::max(worst[replaced ? 1 : 0], error);
          if (t >= kStop + 50) CHECK(std::isfinite(agents[i].report().bound));
        }
        if (t == kStop && replaced) {
          agents.all()[static_cast<std::size_t>(who)] = prepared->agent(who);
          agents[who].reset(run % 2 == 0 ? Vector(Vector::Zero(2))
                                         : Vector(Eigen::Map<const Vector>(x.data() + 2 * who, 2)),
                            t);
          u[static_cast<std::size_t>(who)] = agents[who].control();
        }
      }
      CHECK(least > 10.0);
    }
    CHECK(worst[1] <= 2.0 * worst[0]);
  }
}

TEST_CASE(
    "a vehicle that does not know where it is keeps its speed, and its followers' gaps stay certified") {
  test::Rng rng(33);
  for (int run = 0; run < 60; ++run) {
    const Road r = road(rng);
    test::StringByHand string(r.p, r.p.params, r.start, static_cast<std::uint64_t>(run), "extreme");
    const int who = test::whole(rng, 0, string.N() - 1);
    test::Promises kept;
    for (int t = 0; t <= 200; ++t) {
      const double speed = string.truth(who)[1];
      string.step(t);
      string.judge({}, kept);
      if (t > 100 && t <= 130) CHECK(std::abs(string.truth(who)[1] - speed) <= r.p.setting.eps);
      // It is replaced again and again, so that it says nothing for three seconds.
      if (t >= 100 && t < 130) string.replace(who, Vec<2>::Zero());
    }
    CAPTURE(run);
    CAPTURE(who);
    check_kept(kept);
    CHECK(kept.least_gap > 10.0);
  }
}

TEST_CASE("a vehicle that paused and listens takes nothing from its past") {
  test::Rng rng(35);
  for (int run = 0; run < 12; ++run) {
    const Road r = road(rng);
    const int N = r.p.setting.vehicles;
    const int who = test::whole(rng, r.p.setting.range, N - 1 - r.p.setting.range);
    ParamMap params = r.p.params;
    params["detector"] = false;
    const auto prepared = make_filter("platoon", params)->prepare(r.p.model, r.p.network);
    test::AgentsByHand agents(*prepared, r.p.network);
    for (int i = 0; i < N; ++i) agents[i].reset(r.start.x0.segment(2 * i, 2));
    // Those ahead fall back by 10 m meanwhile, so that the gap it remembers is as wrong as its position.
    const auto position = [&](int t, int i) { return 1.0 * t - 20.0 * i - (t > 40 && i < who ? 10.0 : 0.0); };
    const auto y = [&](int t) {
      return [&, t](int i) {
        Vector all(r.p.model.outputs(i));
        all[0] = position(t, i);
        all[1] = 10.0;
        if (i > 0) all.tail(2) = Vector{{-20.0, 0.0}};
        return all;
      };
    };
    for (int t = 0; t <= 20; ++t) agents.step(t, y(t));
    for (int t = 21; t <= 60; ++t) agents.step(t, y(t), who);
    REQUIRE(agents[who].listen(61) == Refusal::none);
    std::vector<std::byte> body(agents[who].most_bytes());
    for (int j = 0; j < N; ++j) {
      if (j == who) continue;
      const Vector measured = y(61)(j);
      const auto sent =
          agents[j].sense(61, {measured.data(), static_cast<std::size_t>(measured.size())}, body);
      if (std::abs(j - who) <= r.p.setting.range)
        CHECK(agents[who].deliver({j, 61, 0}, std::span(body).first(sent.bytes)) == Refusal::none);
    }
    REQUIRE(agents[who].join() == Refusal::none);
    double x[2];
    agents[who].estimate(x);
    CAPTURE(who);
    CHECK(std::abs(x[0] - position(61, who)) < 0.5);  // it was 41 m further back
    CHECK(std::isnan(agents[who].report().bound));
  }
}

TEST_CASE("every variant goes on with the same bits from a snapshot") {
  test::Rng rng(34);
  for (int run = 0; run < 4; ++run) {
    const auto p = test::random_platoon(rng);
    const int N = p.setting.vehicles;
    const auto start = test::random_start(rng, p.setting);
    for (const auto& filter : test::every_platoon_filter(p.params)) {
      CAPTURE(filter->name());
      const auto prepared = filter->prepare(p.model, p.network);
      test::AgentsByHand kept(*prepared, p.network);
      test::AgentsByHand restored(*prepared, p.network);
      for (int i = 0; i < N; ++i) kept[i].reset(start.estimate.col(i));
      const auto measured = [&](int t) {
        return [&, t](int i) {
          Vector y(p.model.outputs(i));
          for (Eigen::Index k = 0; k < y.size(); ++k)
            y[k] = (k == 0   ? start.x0(2 * i) + 0.1 * t
                    : k == 2 ? -20.0
                             : 10.0 * (k == 1)) +
                   0.01 * std::sin(7.0 * t + 3.0 * i + static_cast<double>(k)) +
                   (i == 1 && k < 2 && t > 5 ? 500.0 : 0.0);
          return y;
        };
      };
      std::vector<double> a;
      std::vector<double> b;
      std::vector<std::byte> x;
      std::vector<std::byte> z;
      for (int t = 0; t <= 60; ++t) {
        kept.step(t, measured(t));
        if (t > 20) restored.step(t, measured(t));
        for (int i = 0; t == 20 && i < N; ++i) {
          std::vector<std::byte> snapshot(kept[i].snapshot_bytes());
          REQUIRE(kept[i].save(snapshot) == snapshot.size());
          REQUIRE(restored[i].load(snapshot) == Refusal::none);
        }
        if (t < 20) continue;
        kept.append_estimates(a);
        restored.append_estimates(b);
        for (int i = 0; i < N; ++i) {  // everything that it remembers
          x.resize(kept[i].snapshot_bytes());
          z.resize(restored[i].snapshot_bytes());
          REQUIRE(kept[i].save(x) == x.size());
          REQUIRE(restored[i].save(z) == z.size());
          CHECK(x == z);
        }
      }
      CHECK(a.size() == b.size());
      CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
    }
  }
}
