// SPDX-License-Identifier: Apache-2.0
// Measurements that follow from the estimate in an agent's first message are not sent for certificates.
#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <functional>

#include "../certificate/random_network.hpp"
#include "../random_system.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/design_file.hpp"

using namespace garrison;
using certificate::Spread;
using certificate::Wanted;

namespace {

constexpr int kAgents = 7;

std::shared_ptr<const AnyFilter> clipping() {
  return make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{3}}});
}

/// Of the first message of an agent that starts at x0 and measures y.
std::vector<std::byte> first_message(const Prepared& prepared, int id, const Vector& x0, double y) {
  const auto agent = prepared.agent(id);
  REQUIRE(agent->reset(x0) == Refusal::none);
  std::vector<std::byte> body(agent->most_bytes());
  const auto sent = agent->sense(1, {&y, 1}, body);
  REQUIRE(sent.refusal == Refusal::none);
  body.resize(sent.bytes);
  return body;
}
/// What a certificate adds to it.
std::size_t added(const Prepared& prepared, int id, const Vector& x0, double y) {
  return first_message(prepared, id, x0, y).size() - first_message(*prepared.with(nullptr), id, x0, y).size();
}

}  // namespace

TEST_CASE("a measurement that was used in full takes no bytes, a clipped one those of a number") {
  test::Rng rng(4);
  const Model model = test::scalar_model(rng, 3, kAgents, 0.98, 0.02, 0.01);
  const Network network = Network::complete(kAgents);
  const Vector x0 = Vector::Zero(3);
  constexpr std::size_t kBare = 1 + 1 + 2 + 2;  // bits of measurement and ball, two counts
  for (const double failure : {0.0, 1e-6})
    for (const char* name : {"saturation", "scalar_gain", "dkf"}) {
      CAPTURE(name);
      const bool clips = name == std::string("saturation");
      const bool carries = name != std::string("dkf");
      const auto plain = (clips ? clipping() : make_filter(name, {}))->prepare(model, network);
      Wanted wanted{Spread::local, failure, 1, 1000};
      wanted.memory = failure > 0.0;
      const auto local = certified(*plain, wanted);
      CHECK(added(*local, 2, x0, 0.1) == (carries ? 0 : kBare + 8));
      CHECK(added(*local, 2, x0, 40.0) == (carries && !clips ? 0 : kBare + 8));
      CHECK(added(*local, 2, x0, kNaN) == (carries ? kBare : 0));
      wanted.spread = Spread::direct;
      CHECK(added(*certified(*plain, wanted), 2, x0, 0.1) == 1 + 8);
    }
}

TEST_CASE("what an agent of one round says after it holds no empty evidence, which is for first rounds") {
  test::Rng rng(4);
  const Model model = test::scalar_model(rng, 3, kAgents, 0.98, 0.02, 0.01);
  const auto plain = make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{1}}})
                         ->prepare(model, Network::complete(kAgents));
  const auto agent = certified(*plain, {Spread::local, 1e-6, 1, 1000})->agent(2);
  std::vector<std::byte> body(agent->most_bytes());
  const std::size_t first = agent->sense(1, std::array{kNaN}, body).bytes;
  body.resize(agent->fuse(body).bytes);
  CHECK(first == body.size() + 6);
  const wire::Letter after{"saturation", 0, {2, 1, 1}, kAgents, agent->fields(2, 1), body};
  CHECK(after.values().size() == after.fields.size());
}

TEST_CASE("only in the first message of an agent with a sensor evidence may hold nothing") {
  test::Rng rng(4);
  const Model model = test::scalar_model(rng, 3, kAgents, 0.98, 0.02, 0.01);
  const Network network = Network::complete(kAgents);
  for (const char* name : {"saturation", "dkf"}) {
    CAPTURE(name);
    const bool carries = name == std::string("saturation");
    const auto prepared = certified(*(carries ? clipping() : make_filter(name, {}))->prepare(model, network),
                                    {Spread::local, 1e-6, 1, 1000});
    auto body = first_message(*prepared, 2, Vector::Zero(3), kNaN);
    if (!carries) body.resize(body.size() + 6);
    const auto listener = prepared->agent(1);
    REQUIRE(listener->listen(1) == Refusal::none);
    CHECK(listener->deliver({2, 1, 0}, body) == (carries ? Refusal::none : Refusal::size));
    if (listener->rounds() > 1) CHECK(listener->deliver({2, 1, 1}, body) == Refusal::size);
    const wire::Letter letter{name, 0, {2, 1, 0}, kAgents, listener->fields(2, 1), body};
    if (carries) CHECK(letter.with(letter.fields.front().name, letter.values().front()).body == body);
  }
}

TEST_CASE("bounds hold where measurements are derived, at the origin and ten million deviations away") {
  long bounds = 0;
  long violations = 0;
  std::array<std::size_t, 4> bytes{};  // of first messages, by distance
  for (int k = 0; k < 240; ++k) {
    test::Rng rng(9000 + static_cast<std::uint64_t>(k));
    const int n = test::whole(rng, 1, 3);
    const double width = 0.05;
    const Model model = test::scalar_model(rng, n, kAgents, 1.0, 0.02, width);
    const Network network = test::connected_network(rng, kAgents, 0.6);
    const auto distance = static_cast<std::size_t>(k) % 4;
    const double size = std::array{0.0, 1e3, 1e5, 1e7}[distance] * width;
    Wanted wanted{Spread::local, k % 8 < 4 ? 0.0 : 1e-9, 1, 1000};
    wanted.memory = k % 8 >= 4 && k % 5 == 0;
    const auto filter = k % 7 == 0 ? make_filter("scalar_gain", {{"rounds", std::int64_t{3}}}) : clipping();
    const Vector x0 = size * test::unit_vector(rng, n);
    RunOptions o;
    o.start = x0;
    o.seed = static_cast<std::uint64_t>(k);
    const auto prepared = certified(*filter->prepare(model, network), wanted);
    const PlantOptions plant{30, x0, 0.0, wanted.failure == 0.0 ? "extreme" : "normal"};
    for (int i = 0; i < kAgents; ++i)
      bytes[distance] += added(*prepared, i, x0, (model.C(i) * model.A() * x0)(0) + 0.6 * width);
    if (k % 3 != 0) o.link.drop = 0.2;
    o.attacks = {bias(Schedule(5, {1}, 20), 0.3), denial(Schedule(1, {4}, 5))};
    const Record r = simulate(*prepared, plant, o);
    for (std::size_t at = 0; at < r.bound.size(); ++at) {
      if (!std::isfinite(r.bound[at])) continue;
      ++bounds;
      violations += r.error[at] > r.bound[at] * (1.0 + 1e-12) ? 1 : 0;
    }
  }
  MESSAGE(bounds << " bounds; bytes of first messages: " << bytes[0] << " at the origin, " << bytes[1] << ", "
                 << bytes[2] << ", " << bytes[3] << " far away");
  CHECK(violations == 0);
  CHECK(bounds > 10000);
  CHECK(bytes[0] == 0);
  CHECK(bytes[3] > 10 * bytes[1]);
}

namespace {

constexpr int kSamples = 20;
constexpr int kLiar = 2;
using Lie = std::function<wire::Letter(const wire::Letter&)>;

/// Runs engine and agents of bytes on y (agents x samples), the liar's messages changed by `attacks` and by
/// `lie`, and compares the bits of bounds; how many differ from those without lies.
int moved_bounds(const Prepared& prepared, const Network& network, const Matrix& y,
                 std::vector<std::shared_ptr<const MessageAttack>> attacks, const Lie& lie) {
  const Matrix x0 = Matrix::Zero(prepared.agent(0)->states(), kAgents);
  Link lying(network, {}, std::move(attacks), 0, 0);
  const auto runner = prepared.runner(1);
  const auto honest = prepared.runner(1);
  runner->reset(x0, &lying);
  honest->reset(x0, nullptr);

  std::vector<std::unique_ptr<Agent>> agents;
  for (int i = 0; i < kAgents; ++i) agents.push_back(prepared.agent(i));
  std::vector<std::vector<std::byte>> sent(kAgents);
  const auto speak = [&](int i, const auto& step) {
    auto& body = sent[static_cast<std::size_t>(i)];
    body.resize(agents[static_cast<std::size_t>(i)]->most_bytes());
    body.resize(step(*agents[static_cast<std::size_t>(i)], body).bytes);
  };
  int moved = 0;
  for (int t = 1; t <= kSamples; ++t) {
    for (int i = 0; i < kAgents; ++i)
      speak(i, [&](Agent& agent, auto& body) { return agent.sense(t, {&y(i, t - 1), 1}, body); });
    for (int round = 0; round < agents.front()->rounds(); ++round) {
      const wire::Letter letter{"saturation", 0, {kLiar, t, round}, kAgents, agents[0]->fields(kLiar, t),
                                sent[kLiar]};
      const auto told = lie(letter).body;
      for (int i = 0; i < kAgents; ++i)
        for (const int j : network.neighbours(i))
          REQUIRE(agents[static_cast<std::size_t>(i)]->deliver(
                      {j, t, round}, j == kLiar ? told : sent[static_cast<std::size_t>(j)]) == Refusal::none);
      for (int i = 0; i < kAgents; ++i) speak(i, [&](Agent& agent, auto& body) { return agent.fuse(body); });
    }
    std::array<double, kAgents> bound{};
    std::array<double, kAgents> unmoved{};
    std::array<std::uint8_t, kAgents> kind{};
    Frame frame;
    frame.bound_kind = kind.data();
    frame.bound = unmoved.data();
    honest->step(t, y.col(t - 1).data());
    honest->read(frame);
    frame.bound = bound.data();
    runner->step(t, y.col(t - 1).data());
    runner->read(frame);
    for (std::size_t i = 0; i < kAgents; ++i) {
      CAPTURE(t);
      CAPTURE(i);
      const double found = agents[i]->report().bound;
      CHECK(std::memcmp(&bound[i], &found, sizeof found) == 0);
      moved += bound[i] == unmoved[i] ? 0 : 1;
    }
  }
  return moved;
}

/// A lie in the estimate alone.
wire::Letter shifted(const wire::Letter& letter, double offset) {
  auto estimate = std::get<std::vector<double>>(letter.values().front());
  for (double& one : estimate) one += offset;
  return letter.with(letter.fields.front().name, estimate);
}

Model plant(test::Rng& rng) { return test::scalar_model(rng, 2, kAgents, 0.95, 0.02, 0.1); }
Matrix small_measurements(test::Rng& rng) { return 0.05 * test::normal_matrix(rng, kAgents, kSamples); }

}  // namespace

TEST_CASE("what follows from a first message that lies counts as a measurement, in engine and agents alike") {
  constexpr double kOffset = 0.03125;
  test::Rng rng(12);
  const Network network = Network::complete(kAgents);
  const auto prepared = certified(*clipping()->prepare(plant(rng), network), {Spread::local, 0.0, 1, 1000});
  Matrix y = small_measurements(rng);
  const auto run = [&] {
    return moved_bounds(*prepared, network, y, {forge(Schedule(1, {kLiar}), kOffset, false)},
                        [&](const wire::Letter& letter) { return shifted(letter, kOffset); });
  };
  CHECK(run() > kSamples);
  y.row(kLiar).setConstant(kNaN);  // said to be missing: nothing follows
  CHECK(run() > 0);
}

TEST_CASE("who withholds what it says beside its estimate says the estimate, in engine and agents alike") {
  const Schedule always(1, {kLiar});
  const auto run = [&](const Network& network, int rounds, double measured) {
    CAPTURE(rounds);
    test::Rng rng(12);
    const auto filter =
        make_filter("saturation", {{"threshold", 0.5}, {"rounds", static_cast<std::int64_t>(rounds)}});
    const auto prepared = certified(*filter->prepare(plant(rng), network), {Spread::local, 0.0, 1, 1000});
    Matrix y = small_measurements(rng);
    y.row(kLiar).array() += measured;
    return moved_bounds(*prepared, network, y,
                        {falsify(always, "certificate.measurements", kNaN, {}),
                         falsify(always, "certificate.ball", kNaN, {})},
                        [](const wire::Letter& letter) {
                          return letter.with("certificate.measurements", std::vector{kNaN})
                              .with("certificate.ball", std::vector<double>(3, kNaN));
                        });
  };
  // The number was clipped: what follows is another one.
  CHECK(run(Network::complete(kAgents), 3, 2.0) > kSamples);
  // It follows, but is sent with the region, which is in first messages where the network is wider than the
  // rounds.
  CHECK(run(Network::band(kAgents, 3), 1, 0.0) == 0);
}
