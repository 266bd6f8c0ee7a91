// SPDX-License-Identifier: Apache-2.0
// Agents that stop, start again, and come to a network that runs already.
#include <doctest/doctest.h>

#include <cstring>

#include "../agents_by_hand.hpp"
#include "../every_filter.hpp"
#include "../random_system.hpp"
#include "garrison/engine/design_file.hpp"

using namespace garrison;

namespace {

constexpr int kAgents = 5;
constexpr int kStop = 100;
constexpr int kEnd = 300;

/// A plant that keeps moving, so that an estimate of nothing is far off.
struct Plant {
  Model model;
  Network network = Network::ring(kAgents);
  std::vector<Vector> x;
  Matrix y;
};

Plant plant(std::uint64_t seed) {
  test::Rng rng(seed);
  const double angle = 0.1;
  Matrix A(2, 2);
  A << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  std::vector<Matrix> C;
  for (int i = 0; i < kAgents; ++i) C.push_back(Matrix{{std::cos(1.3 * i), std::sin(1.3 * i)}});
  const Matrix Sw = 1e-4 * Matrix::Identity(2, 2);
  const std::vector<Matrix> Sv(kAgents, Matrix::Constant(1, 1, 1e-3));
  Plant p{{A, C, {0.02, Vector::Constant(kAgents, 0.05), Sw, Sv}},
          Network::ring(kAgents),
          {},
          Matrix(kEnd, kAgents)};
  Vector x{{6.0, -5.0}};
  for (int t = 0; t <= kEnd; ++t) {
    p.x.push_back(x);
    for (int i = 0; i < kAgents && t > 0; ++i)
      p.y(t - 1, i) = (p.model.C(i) * x)(0) + test::uniform(rng, -0.05, 0.05);
    x = A * x + 0.01 * Vector{{test::uniform(rng, -1, 1), test::uniform(rng, -1, 1)}};
  }
  return p;
}

Vector measured(const Plant& p, std::int64_t t, int i) {
  return Vector::Constant(1, p.y(static_cast<Eigen::Index>(t) - 1, i));
}
Vector estimate(const Agent& agent) {
  Vector x(agent.states());
  agent.estimate({x.data(), static_cast<std::size_t>(x.size())});
  return x;
}

/// Largest error of agent 2 over samples [from, to], and the bounds on the way; `at_stop(agents)` changes
/// agents after sample kStop.
template <class AtStop>
double worst_error(const Plant& p, const AnyFilter& filter, int from, int to, const AtStop& at_stop) {
  const auto prepared = filter.prepare(p.model, p.network);
  test::AgentsByHand agents(*prepared, p.network);
  for (const auto& agent : agents.all()) agent->reset(p.x[0]);
  double worst = 0.0;
  for (int t = 1; t <= to; ++t) {
    agents.step(t, [&](int i) { return measured(p, t, i); });
    for (int i = 0; i < kAgents; ++i) {
      const double error = (estimate(agents[i]) - p.x[static_cast<std::size_t>(t)]).norm();
      const double bound = agents[i].report().bound;
      if (!std::isnan(bound) && !(error <= bound)) FAIL("error " << error << " over the bound " << bound);
      if (i == 2 && t >= from) worst = std::max(worst, error);
    }
    if (t == kStop) at_stop(agents, *prepared);
  }
  return worst;
}

}  // namespace

TEST_CASE("an agent that is replaced in a running network is as good as before within 50 samples") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Plant p = plant(seed);
    for (const auto& filter : test::every_filter()) {
      CAPTURE(filter->name());
      const double undisturbed = worst_error(p, *filter, kStop + 50, kEnd, [](auto&, const Prepared&) {});
      const double fresh =
          worst_error(p, *filter, kStop + 50, kEnd, [](auto& agents, const Prepared& prepared) {
            agents.all()[2] = prepared.agent(2);
            agents[2].reset(Vector::Zero(2), kStop);
          });
      CHECK(fresh <= 2.0 * undisturbed);
      // Entries that no neighbour shares at that sample stay as they are: partial sharing takes what it is
      // told.
      const double far = filter->name() == "partial_sharing" ? 0.0 : 1e6;
      const double deaf =
          worst_error(p, *filter, kStop + 50, kEnd, [&](auto& agents, const Prepared& prepared) {
            // It listened, but nothing came: it must not tell anybody what it starts from.
            agents.all()[2] = prepared.agent(2);
            agents[2].reset(Vector::Constant(2, far), kStop - 1);
            REQUIRE(agents[2].listen(kStop) == Refusal::none);
            agents[2].join();
          });
      CHECK(deaf <= 2.0 * undisturbed);
    }
  }
}

TEST_CASE("an agent that joins takes over what its neighbours say, at once") {
  const Plant p = plant(4);
  for (const auto& filter : test::every_filter()) {
    if (filter->name() == "partial_sharing" || filter->name() == "rdkf" || filter->name() == "dkf") continue;
    CAPTURE(filter->name());
    const auto prepared = filter->prepare(p.model, p.network);
    test::AgentsByHand agents(*prepared, p.network);
    for (const auto& agent : agents.all()) agent->reset(p.x[0]);
    for (int t = 1; t <= 20; ++t) agents.step(t, [&](int i) { return measured(p, t, i); });
    std::vector<Vector> before;
    for (int i = 0; i < kAgents; ++i) before.push_back(estimate(agents[i]));
    const auto late = prepared->agent(2);
    REQUIRE(late->listen(21) == Refusal::none);
    std::vector<std::byte> body(late->most_bytes());
    for (const int j : {1, 3}) {
      const Vector y = measured(p, 21, j);
      const auto sent = agents[j].sense(21, {y.data(), 1}, body);
      CHECK(late->deliver({j, 21, 0}, std::span(body).first(sent.bytes)) == Refusal::none);
    }
    CHECK(late->join() == Refusal::none);
    CHECK(late->sample() == 21);
    double theirs = 0.0;  // of a filter that is slow they are off themselves
    for (const int j : {1, 3})
      theirs = std::max(theirs, (before[static_cast<std::size_t>(j)] - p.x[20]).norm());
    CHECK((estimate(*late) - p.x[21]).norm() < std::max(0.5, 1.2 * theirs));  // it is 7.8 from zero
    CHECK(std::isnan(late->report().bound));
  }
}

TEST_CASE("an agent that is stopped and restored goes on with the same bits, from a file of its own") {
  const Plant p = plant(5);
  for (const auto& filter : test::every_filter()) {
    CAPTURE(filter->name());
    const auto prepared = filter->prepare(p.model, p.network);
    test::AgentsByHand kept(*prepared, p.network);
    test::AgentsByHand restored(*prepared, p.network);
    std::vector<double> a;
    std::vector<double> b;
    for (int t = 1; t <= kEnd; ++t) {
      kept.step(t, [&](int i) { return measured(p, t, i); });
      if (t < kStop) continue;
      kept.append_estimates(a);
      if (t > kStop) restored.step(t, [&](int i) { return measured(p, t, i); });
      for (int i = 0; t == kStop && i < kAgents; ++i) {
        std::vector<std::byte> snapshot(kept[i].snapshot_bytes());
        REQUIRE(kept[i].save(snapshot) == snapshot.size());
        restored.all()[static_cast<std::size_t>(i)] = read_part(write_part(*prepared, i));
        CHECK(restored[i].load(snapshot) == Refusal::none);
        CHECK(restored[i].sample() == kStop);
        CHECK(std::memcmp(&(const double&)kept[i].report().bound, &(const double&)restored[i].report().bound,
                          8) == 0);
        CHECK(kept[i].report().verdict == restored[i].report().verdict);
      }
      restored.append_estimates(b);
    }
    CHECK(a.size() == b.size());
    CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
  }
}

TEST_CASE("a design goes through a file with the same bits, hash and parts") {
  const Plant p = plant(6);
  for (const auto& filter : test::every_filter()) {
    CAPTURE(filter->name());
    const auto prepared = filter->prepare(p.model, p.network);
    const auto file = write_design(*prepared);
    const auto again = read_design(file);
    CHECK(write_design(*again) == file);
    CHECK(again->fingerprint() == prepared->fingerprint());
    for (int i = 0; i < kAgents; ++i) CHECK(write_part(*again, i) == write_part(*prepared, i));
    const DesignSummary s = summary_of(file);
    CHECK(s.filter == filter->name());
    CHECK(s.agents == kAgents);
    const std::size_t step = file.size() / static_cast<std::size_t>(test::tried(1000)) + 1;
    for (std::size_t k = 0; k < file.size(); k += step) {
      auto damaged = file;
      damaged[k] ^= std::byte{16};
      CHECK_THROWS_AS(read_design(damaged), InvalidInput);
    }
    CHECK_THROWS_WITH_AS(read_design(write_part(*prepared, 3)), doctest::Contains("the part of agent 3"),
                         InvalidInput);
    CHECK_THROWS_WITH_AS(read_part(file), doctest::Contains("a whole design"), InvalidInput);
  }
}

TEST_CASE("calls out of turn and messages of others are refused by name") {
  const Plant p = plant(7);
  const auto prepared = make_filter("saturation", {{"threshold", 1.0}, {"rounds", std::int64_t{2}}})
                            ->prepare(p.model, p.network);
  const auto agent = prepared->agent(0);
  const auto neighbour = prepared->agent(1);
  std::vector<std::byte> body(agent->most_bytes());
  const double y = 1.0;
  CHECK(agent->fuse(body).refusal == Refusal::order);
  CHECK(agent->join() == Refusal::order);
  CHECK(agent->sense(1, {&y, 0}, body).refusal == Refusal::size);
  CHECK(agent->sense(1, {&y, 1}, std::span(body).first(3)).refusal == Refusal::size);
  CHECK(agent->sense(0, {&y, 1}, body).refusal == Refusal::late);
  CHECK(agent->sense(2000, {&y, 1}, body).refusal == Refusal::early);
  REQUIRE(agent->sense(1, {&y, 1}, body).bytes > 0);
  CHECK(agent->sense(2, {&y, 1}, body).refusal == Refusal::order);
  CHECK(agent->listen(5) == Refusal::order);
  std::vector<std::byte> snapshot(agent->snapshot_bytes());
  CHECK(agent->save(snapshot) == 0);
  CHECK(agent->load(snapshot) == Refusal::order);

  const auto sent = neighbour->sense(1, {&y, 1}, body);
  const auto message = std::span(body).first(sent.bytes);
  CHECK(agent->deliver({2, 1, 0}, message) == Refusal::stranger);
  CHECK(agent->deliver({0, 1, 0}, message) == Refusal::stranger);
  CHECK(agent->deliver({1, 0, 0}, message) == Refusal::late);
  CHECK(agent->deliver({1, 3, 0}, message) == Refusal::early);
  CHECK(agent->deliver({1, 1, 2}, message) == Refusal::early);
  CHECK(agent->deliver({1, 1, -1}, message) == Refusal::early);
  CHECK(agent->deliver({1, 1, 0}, message.first(message.size() - 1)) == Refusal::size);
  CHECK(!agent->has(1));
  CHECK(agent->deliver({1, 1, 0}, message) == Refusal::none);
  CHECK(agent->has(1));
  CHECK(agent->deliver({1, 1, 0}, message) == Refusal::duplicate);
  CHECK(agent->deliver({1, 2, 1}, message) == Refusal::none);  // early, and waits
  CHECK(agent->fuse(body).refusal == Refusal::none);
  CHECK(agent->deliver({1, 1, 0}, message) == Refusal::late);
  CHECK(agent->fuse(body).refusal == Refusal::none);

  REQUIRE(agent->save(snapshot) == snapshot.size());
  CHECK(prepared->agent(2)->load(snapshot) == Refusal::foreign);
  const auto other = make_filter("saturation", {{"threshold", 2.0}, {"rounds", std::int64_t{2}}})
                         ->prepare(p.model, p.network)
                         ->agent(0);
  CHECK(other->load(snapshot) == Refusal::foreign);
  CHECK(other->load(std::span(snapshot).first(10)) == Refusal::size);
  for (std::size_t k = 24; k < snapshot.size(); ++k) {
    auto damaged = snapshot;
    damaged[k] ^= std::byte{1};
    CHECK(agent->load(damaged) == Refusal::damaged);
  }
  CHECK(agent->load(snapshot) == Refusal::none);
  CHECK_THROWS_WITH_AS(prepared->agent(5), doctest::Contains("id: got 5"), InvalidInput);
  CHECK(agent->reset(Vector::Zero(3), 0) == Refusal::size);
  CHECK(agent->reset(Vector::Constant(2, kNaN), 0) == Refusal::number);
  CHECK(agent->reset(Vector::Zero(2), -1) == Refusal::late);
  CHECK(agent->reset(Vector::Zero(2), INT64_MAX) == Refusal::early);
}

TEST_CASE("samples that were missed are made up for, and nothing is claimed that they may have broken") {
  const Plant p = plant(8);
  for (const auto& filter : test::every_filter()) {
    CAPTURE(filter->name());
    const auto prepared = filter->prepare(p.model, p.network);
    const auto agent = prepared->agent(0);
    const auto twin = prepared->agent(0);
    std::vector<std::byte> body(agent->most_bytes());
    const double y = 0.02;  // what no screen leaves out
    const double nothing = kNaN;
    for (std::int64_t t = 1; t <= 9; ++t) {
      REQUIRE(twin->sense(t, {t == 9 ? &y : &nothing, 1}, body).refusal == Refusal::none);
      while (twin->round() < twin->rounds()) twin->fuse(body);
    }
    REQUIRE(agent->sense(9, {&y, 1}, body).refusal == Refusal::none);
    while (agent->round() < agent->rounds()) agent->fuse(body);
    CHECK(estimate(*agent) == estimate(*twin));
    CHECK(std::isnan(agent->report().bound));
    const auto params = filter->params();
    const auto detector = params.find("detector");
    if (filter->name() == "structural" || (detector != params.end() && std::get<bool>(detector->second)))
      CHECK(agent->report().verdict == Verdict::not_tested);
  }
}
