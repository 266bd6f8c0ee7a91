// SPDX-License-Identifier: Apache-2.0
// Gains that follow a plant: with matrices that stay they have the bits of a constant one; with others those
// of agents driven by bytes, whatever is lost and wherever an agent is saved. The numbers:
// tests/python/test_varying_sharing.py.
#include <doctest/doctest.h>

#include <cstring>

#include "../../agents_by_hand.hpp"
#include "garrison/core/series.hpp"
#include "garrison/engine/any_filter.hpp"
#include "random_setting.hpp"

using namespace garrison;

namespace {

constexpr std::uint64_t kSeed = 20261201;
constexpr int kAgents = 13;  // a full group and a part of one
constexpr int kSteps = 30;

struct Moment {
  Matrix A, C, Q, W;
  Change change() const { return {.A = &A, .C = &C, .Q = &Q, .W = &W}; }
};

struct Problem {
  Model model;
  Network network;
  Matrix y;
  std::vector<Moment> plant;  // of every sample

  Problem(int n, test::Rng rng) : model(draw(n, rng)), network(test::connected_network(rng, kAgents)) {
    y = test::normal_matrix(rng, kSteps, model.total_outputs());
    for (int t = 0; t < kSteps; ++t)
      y(t, test::whole(rng, 0, model.total_outputs() - 1)) = t % 2 ? kNaN : 1e300;
    for (int t = 0; t < kSteps; ++t) plant.push_back(moment(draw(n, rng)));
  }
  static Model draw(int n, test::Rng& rng) {
    std::vector<Matrix> C;
    Noise noise;
    noise.process_covariance = test::covariance(rng, n, 0.2);
    for (int i = 0; i < kAgents; ++i) {
      const int q = i % 5 == 4 ? n + 1 : i % 3;
      C.push_back(test::normal_matrix(rng, q, n));
      noise.measurement_covariance.push_back(q == 0 ? Matrix(0, 0) : test::covariance(rng, q, 1.0));
    }
    return {test::normal_matrix(rng, n, n) * (0.7 / n), C, noise};
  }
  static Moment moment(const Model& model) {
    Moment at{model.A(), model.stacked(), model.noise().process_covariance, {}};
    at.W = Matrix::Zero(model.total_outputs(), model.states() + 1);
    for (int i = 0; i < model.agents(); ++i)
      if (const int q = model.outputs(i); q > 0)
        at.W.block(model.offset(i), 0, q, q) =
            whitener(model.noise().measurement_covariance[static_cast<std::size_t>(i)]);
    return at;
  }
};

std::shared_ptr<const Prepared> prepare(const Problem& p, bool given = false, const char* gains = "varying") {
  return make_filter("partial_sharing", {{"gain", 0.1},
                                         {"shared", std::int64_t{(p.model.states() + 1) / 2}},
                                         {"start_variance", 2.5},
                                         {"start_is_prediction", given},
                                         {"gains", std::string(gains)}})
      ->prepare(p.model, p.network);
}

/// Bits of everything that agents report of every sample.
std::vector<double> by_engine(const Problem& p, const Prepared& prepared, const std::vector<Moment>& plant,
                              Link* link = nullptr, bool again = false) {
  const auto runner = prepared.runner(1);
  const Matrix x0 = Matrix::Constant(p.model.states(), kAgents, 0.3);
  std::vector<double> seen;
  for (int run = 0; run <= (again ? 1 : 0); ++run) {
    seen.clear();
    runner->reset(x0, link);
    Matrix estimate(p.model.states(), kAgents);
    std::vector<double> signals(3 * kAgents), expected(static_cast<std::size_t>(p.model.states()) + 1);
    for (int t = 0; t < kSteps; ++t) {
      if (!plant.empty()) runner->vary(plant[static_cast<std::size_t>(t)].change());
      runner->expected(4, expected.data());
      const Vector sample = p.y.row(t);
      runner->step(t + 1, sample.data());
      runner->read({.estimate = estimate.data(), .signals = signals.data()});
      seen.insert(seen.end(), estimate.data(), estimate.data() + estimate.size());
      seen.insert(seen.end(), signals.begin(), signals.end());
      seen.insert(seen.end(), expected.begin(), expected.end());
    }
  }
  return seen;
}

std::vector<double> estimates_by_engine(const Problem& p, const Prepared& prepared, Link* link) {
  const auto runner = prepared.runner(1);
  runner->reset(Matrix::Constant(p.model.states(), kAgents, 0.3), link);
  std::vector<double> seen;
  Matrix estimate(p.model.states(), kAgents);
  for (int t = 0; t < kSteps; ++t) {
    runner->vary(p.plant[static_cast<std::size_t>(t)].change());
    const Vector sample = p.y.row(t);
    runner->step(t + 1, sample.data());
    runner->estimates(estimate);
    seen.insert(seen.end(), estimate.data(), estimate.data() + estimate.size());
  }
  return seen;
}

void tell(Agent& agent, const Model& model, const Moment& at) {
  const int q = agent.outputs();
  const Matrix C = at.C.middleRows(model.offset(agent.id()), q);
  const Matrix W = at.W.block(model.offset(agent.id()), 0, q, q);
  REQUIRE(agent.vary({.A = &at.A, .C = &C, .Q = &at.Q, .W = &W}) == Refusal::none);
}

/// Agent 4 is saved and goes on from there as a new one, now and then.
std::vector<double> estimates_by_hand(const Problem& p, const Prepared& prepared, const Link* link) {
  test::AgentsByHand agents(prepared, p.network, link);
  for (const auto& agent : agents.all()) agent->reset(Vector::Constant(p.model.states(), 0.3));
  std::vector<double> seen;
  for (int t = 0; t < kSteps; ++t) {
    if (t % 7 == 3) {
      std::vector<std::byte> snapshot(agents[4].snapshot_bytes());
      REQUIRE(agents[4].save(snapshot) == snapshot.size());
      agents.all()[4] = prepared.agent(4);
      REQUIRE(agents[4].load(snapshot) == Refusal::none);
    }
    for (const auto& agent : agents.all()) tell(*agent, p.model, p.plant[static_cast<std::size_t>(t)]);
    agents.step(t + 1,
                [&](int i) { return Vector(p.y.row(t).segment(p.model.offset(i), p.model.outputs(i))); });
    agents.append_estimates(seen);
  }
  return seen;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("gains that follow a plant whose matrices stay have the bits of the constant one") {
  for (const int n : {1, 2, 3, 4, 7, 8, 9})
    for (const bool given : {false, true}) {
      CAPTURE(n);
      CAPTURE(given);
      const Problem p(n, test::Rng(kSeed + static_cast<std::uint64_t>(n)));
      const std::vector<Moment> still(kSteps, Problem::moment(p.model));
      const auto prepared = prepare(p, given);
      const auto constant = by_engine(p, *prepared, {});
      CHECK(same(constant, by_engine(p, *prepared, still)));
      CHECK_FALSE(same(constant, by_engine(p, *prepared, p.plant)));
      CHECK(same(constant, by_engine(p, *prepared, still, nullptr, true)));  // after a run, once more
    }
}

TEST_CASE("a network whose plant changes has the bits of its agents, driven by bytes") {
  for (const int n : {1, 2, 4, 8, 9})
    for (const bool given : {false, true}) {
      CAPTURE(n);
      CAPTURE(given);
      const Problem p(n, test::Rng(kSeed + 100 + static_cast<std::uint64_t>(n)));
      const auto prepared = prepare(p, given);
      CHECK(same(estimates_by_engine(p, *prepared, nullptr), estimates_by_hand(p, *prepared, nullptr)));
      Link lossy(p.network, {0.3, 0.0, 1}, {}, kSeed, 0);
      const auto with_losses = estimates_by_engine(p, *prepared, &lossy);
      CHECK(lossy.counters.lost > 0);
      CHECK(same(with_losses, estimates_by_hand(p, *prepared, &lossy)));
    }
}

TEST_CASE("an agent refuses a plant that is not its own, and goes back to its design's") {
  const Problem p(3, test::Rng(kSeed));
  const auto prepared = prepare(p);
  auto agent = prepared->agent(1);
  const Matrix wide = Matrix::Zero(3, 4);
  const Matrix endless = Matrix::Constant(3, 3, kInfinity);
  Matrix none = Matrix::Zero(3, 3);
  none(2, 2) = kNaN;
  CHECK(agent->vary({.A = &wide}) == Refusal::size);
  CHECK(agent->vary({.C = &wide}) == Refusal::size);
  CHECK(agent->vary({.Q = &endless}) == Refusal::number);
  for (const Change& one : {Change{.A = &none}, Change{.Q = &none}})
    CHECK(agent->vary(one) == Refusal::number);
  CHECK(prepare(p, false, "frozen")->agent(1)->vary({}) == Refusal::foreign);
  CHECK(prepare(p, false, "steady")->agent(1)->vary({}) == Refusal::foreign);

  const auto untold = prepared->agent(1);
  const Vector x0 = Vector::Constant(3, 0.3);
  const std::vector<double> y(1, 0.5);
  std::vector<std::byte> body(agent->most_bytes());
  const auto after = [&](Agent& one) {
    REQUIRE(one.sense(1, y, body).refusal == Refusal::none);
    CHECK(one.vary({}) == Refusal::order);
    REQUIRE(one.fuse(body).refusal == Refusal::none);
    std::vector<double> x(3);
    one.estimate(x);
    return x;
  };
  agent->reset(x0);
  tell(*agent, p.model, p.plant[0]);
  const auto told = after(*agent);
  CHECK(agent->report().kind == CertificateKind::varying);
  agent->reset(x0);
  untold->reset(x0);
  const auto constant = after(*untold);
  CHECK_FALSE(same(told, constant));
  CHECK(same(after(*agent), constant));
  CHECK(agent->report().kind != CertificateKind::varying);
}

TEST_CASE("what an agent was told once and then is not is the design's again") {
  const Problem p(3, test::Rng(kSeed + 200));
  const auto prepared = prepare(p);
  const Moment design = Problem::moment(p.model);
  constexpr int id = 4;
  const int q = p.model.outputs(id);
  const auto own = [&](const Moment& at) {
    return Moment{at.A, at.C.middleRows(p.model.offset(id), q), at.Q,
                  at.W.block(p.model.offset(id), 0, q, q)};
  };
  const Moment other = own(p.plant[0]);
  const Moment constant = own(design);
  // Three samples of which the second is told `second`, the third `third`.
  const auto after = [&](const Change& second, const Change& third) {
    const auto agent = prepared->agent(id);
    std::vector<std::byte> body(agent->most_bytes());
    agent->reset(Vector::Constant(3, 0.3));
    for (std::int64_t t = 1; t <= 3; ++t) {
      if (t > 1) REQUIRE(agent->vary(t == 2 ? second : third) == Refusal::none);
      REQUIRE(agent->sense(t, std::vector<double>(static_cast<std::size_t>(q), 0.5), body).refusal ==
              Refusal::none);
      REQUIRE(agent->fuse(body).refusal == Refusal::none);
    }
    std::vector<double> x(3);
    agent->estimate(x);
    return x;
  };
  for (const Change& told :
       {Change{.A = &other.A}, Change{.C = &other.C}, Change{.Q = &other.Q}, Change{.W = &other.W}}) {
    CHECK(same(after(told, {}), after(told, constant.change())));
    CHECK_FALSE(same(after(told, {}), after(told, told)));
  }
}

TEST_CASE("an agent that goes on from a snapshot and is told nothing has its design's plant") {
  const Problem p(3, test::Rng(kSeed + 300));
  const auto prepared = prepare(p);
  const Moment design = Problem::moment(p.model);
  constexpr int id = 4;
  const std::vector<double> y(static_cast<std::size_t>(p.model.outputs(id)), 0.5);
  const auto one_more = [&](Agent& agent) {
    std::vector<std::byte> body(agent.most_bytes());
    REQUIRE(agent.sense(agent.sample() + 1, y, body).refusal == Refusal::none);
    REQUIRE(agent.fuse(body).refusal == Refusal::none);
    std::vector<double> x(3);
    agent.estimate(x);
    return x;
  };
  const auto agent = prepared->agent(id);
  tell(*agent, p.model, p.plant[0]);
  one_more(*agent);
  std::vector<std::byte> snapshot(agent->snapshot_bytes());
  REQUIRE(agent->save(snapshot) == snapshot.size());

  const auto loaded = prepared->agent(id);
  tell(*loaded, p.model, p.plant[1]);  // no more than `reset` does `load` keep it
  REQUIRE(loaded->load(snapshot) == Refusal::none);
  CHECK(loaded->report().kind != CertificateKind::varying);
  tell(*agent, p.model, design);
  CHECK(same(one_more(*loaded), one_more(*agent)));
  CHECK(same(one_more(*loaded), one_more(*agent)));
}

TEST_CASE("an agent that was never told goes on from a snapshot with the same bits") {
  for (const bool given : {false, true}) {
    const Problem p(4, test::Rng(kSeed + 400));
    for (const char* gains : {"varying", "frozen", "steady"}) {
      const auto prepared = prepare(p, given, gains);
      test::AgentsByHand kept(*prepared, p.network), renewed(*prepared, p.network);
      std::vector<double> left, right;
      const auto y = [&](int i) { return Vector(p.y.row(0).segment(p.model.offset(i), p.model.outputs(i))); };
      for (int t = 0; t < kSteps; ++t) {
        for (std::size_t i = 0; i < renewed.all().size(); ++i) {
          std::vector<std::byte> snapshot(renewed.all()[i]->snapshot_bytes());
          REQUIRE(renewed.all()[i]->save(snapshot) == snapshot.size());
          renewed.all()[i] = prepared->agent(static_cast<int>(i));
          REQUIRE(renewed.all()[i]->load(snapshot) == Refusal::none);
        }
        kept.step(t + 1, y);
        renewed.step(t + 1, y);
        kept.append_estimates(left);
        renewed.append_estimates(right);
      }
      CHECK(same(left, right));
    }
  }
}
