// SPDX-License-Identifier: Apache-2.0
// Measurements that follow from the estimate in an agent's first message are not sent for certificates.
#include <doctest/doctest.h>

#include <array>
#include <cstring>

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

std::size_t first_bytes(const Prepared& prepared, int id, double y) {
  const auto agent = prepared.agent(id);
  std::vector<std::byte> body(agent->most_bytes());
  const auto sent = agent->sense(1, {&y, 1}, body);
  REQUIRE(sent.refusal == Refusal::none);
  return sent.bytes;
}

/// What the certificate adds to the first messages of a sample without losses, each.
double added(const Prepared& prepared, const PlantOptions& plant, const RunOptions& o) {
  const Record with = simulate(prepared, plant, o);
  const Record without = simulate(*prepared.with(nullptr), plant, o);
  double messages = 0.0;
  for (int i = 0; i < prepared.network().agents(); ++i)
    messages += static_cast<double>(prepared.network().neighbours(i).size());
  return static_cast<double>(with.bytes_per_step - without.bytes_per_step) / messages;
}

}  // namespace

TEST_CASE("a measurement that was used in full takes no bytes, a clipped one those of a number") {
  test::Rng rng(4);
  const Model model = test::scalar_model(rng, 3, kAgents, 0.98, 0.02, 0.01);
  const Network network = Network::complete(kAgents);
  for (const bool memory : {false, true})
    for (const double failure : {0.0, 1e-6}) {
      if (memory && failure == 0.0) continue;
      Wanted wanted{Spread::direct, failure, 1, 1000};
      wanted.memory = memory;
      for (const char* name : {"saturation", "scalar_gain", "dkf"}) {
        CAPTURE(name);
        const auto filter = name == std::string("saturation") ? clipping() : make_filter(name, {});
        const auto plain = filter->prepare(model, network);
        const auto prepared = certified(*plain, wanted);
        const bool carries = name != std::string("dkf");
        const std::size_t used = first_bytes(*plain, 2, 0.1);
        CHECK(first_bytes(*prepared, 2, 0.1) == used + (carries ? 0 : 1 + 8));
        const bool clips = name == std::string("saturation");
        CHECK(first_bytes(*prepared, 2, 40.0) == used + (carries && !clips ? 0 : 1 + 8));
        CHECK(first_bytes(*prepared, 2, kNaN) == first_bytes(*plain, 2, kNaN) + (carries ? 1 : 0));
      }
      wanted.spread = Spread::local;
      CHECK(first_bytes(*certified(*clipping()->prepare(model, network), wanted), 2, 0.1) ==
            first_bytes(*clipping()->prepare(model, network), 2, 0.1));
    }
}

TEST_CASE("nothing but a first message of a sensor may mean by no number that there is none") {
  test::Rng rng(4);
  Model model = test::scalar_model(rng, 3, kAgents, 0.98, 0.02, 0.01);
  const Network network = Network::complete(kAgents);
  const Wanted wanted{Spread::direct, 1e-6, 1, 1000};
  for (const char* name : {"saturation", "dkf"}) {
    const auto filter = name == std::string("saturation") ? clipping() : make_filter(name, {});
    const auto prepared = certified(*filter->prepare(model, network), wanted);
    const auto agent = prepared->agent(2);
    std::vector<std::byte> body(agent->most_bytes());
    const double y = kNaN;
    const bool carries = name == std::string("saturation");
    body.resize(agent->sense(1, {&y, 1}, body).bytes);
    if (!carries) body.push_back(std::byte{0});
    const auto listener = prepared->agent(1);
    const double own = 0.1;
    std::vector<std::byte> room(listener->most_bytes());
    REQUIRE(listener->sense(1, {&own, 1}, room).refusal == Refusal::none);
    CHECK(listener->deliver({2, 1, 0}, body) == (carries ? Refusal::none : Refusal::size));
    if (listener->rounds() > 1) CHECK(listener->deliver({2, 1, 1}, body) == Refusal::size);
  }
}

TEST_CASE("bounds hold where measurements are derived, at the origin and ten million deviations away") {
  long bounds = 0;
  long violations = 0;
  double near = 0.0;
  double far = 0.0;
  for (int k = 0; k < 240; ++k) {
    test::Rng rng(9000 + static_cast<std::uint64_t>(k));
    const int n = test::whole(rng, 1, 3);
    const double width = 0.05;
    const Model model = test::scalar_model(rng, n, kAgents, 1.0, 0.02, width);
    const Network network = test::connected_network(rng, kAgents, 0.6);
    const double size = std::array{0.0, 1e3, 1e5, 1e7}[static_cast<std::size_t>(k) % 4] * width;
    Wanted wanted{k % 3 == 0 ? Spread::direct : Spread::local, k % 2 == 0 ? 0.0 : 1e-9, 1, 1000};
    wanted.memory = k % 2 == 1 && k % 5 == 0;
    const auto filter = k % 7 == 0 ? make_filter("scalar_gain", {{"rounds", std::int64_t{3}}}) : clipping();
    const Vector x0 = size * test::unit_vector(rng, n);
    RunOptions o;
    o.start = x0;
    o.seed = static_cast<std::uint64_t>(k);
    const auto prepared = certified(*filter->prepare(model, network), wanted);
    const PlantOptions plant{30, x0, 0.0, wanted.failure == 0.0 ? "extreme" : "normal"};
    const double bytes = added(*prepared, plant, o);
    if (k % 12 == 0) near += bytes;  // direct
    if (k % 12 == 3) far += bytes;
    if (k % 4 != 0) o.link.drop = 0.2;
    o.attacks = {bias(Schedule(5, {1}, 20), 0.3), denial(Schedule(1, {4}, 5))};
    const Record r = simulate(*prepared, plant, o);
    for (std::size_t at = 0; at < r.bound.size(); ++at) {
      if (!std::isfinite(r.bound[at])) continue;
      ++bounds;
      violations += r.error[at] > r.bound[at] * (1.0 + 1e-12) ? 1 : 0;
    }
  }
  MESSAGE(bounds << " bounds; bytes per first message, direct: " << near / 20 << " at the origin, "
                 << far / 20 << " far away");
  CHECK(violations == 0);
  CHECK(bounds > 10000);
  CHECK(near / 20 < 0.5);
  CHECK(far / 20 > 1.0);  // often no digit is lost
}

TEST_CASE("what follows from a first message that lies counts as a measurement, in engine and agents alike") {
  constexpr int kSamples = 20;
  constexpr int kLiar = 2;
  constexpr double kOffset = 0.03125;
  test::Rng rng(12);
  const Model model = test::scalar_model(rng, 2, kAgents, 0.95, 0.02, 0.1);
  const Network network = Network::complete(kAgents);
  const auto prepared = certified(*clipping()->prepare(model, network), {Spread::direct, 0.0, 1, 1000});
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> y =
      0.05 * test::normal_matrix(rng, kSamples, kAgents);
  RunOptions o;
  const Record honest = replay(*prepared, Log{y.data(), nullptr, 1, kSamples}, o);
  o.message_attacks = {forge(Schedule(1, {kLiar}), kOffset, false)};
  const Record record = replay(*prepared, Log{y.data(), nullptr, 1, kSamples}, o);
  const std::size_t numbers = record.bound.size();
  CHECK(std::memcmp(record.bound.data(), honest.bound.data(), numbers * sizeof(double)) != 0);

  std::vector<std::unique_ptr<Agent>> agents;
  for (int i = 0; i < kAgents; ++i) agents.push_back(prepared->agent(i));
  std::vector<std::vector<std::byte>> sent(kAgents);
  for (int t = 1; t <= kSamples; ++t) {
    const auto speak = [&](int i, const auto& step) {
      auto& body = sent[static_cast<std::size_t>(i)];
      body.resize(agents[static_cast<std::size_t>(i)]->most_bytes());
      body.resize(step(*agents[static_cast<std::size_t>(i)], body).bytes);
    };
    for (int i = 0; i < kAgents; ++i)
      speak(i, [&](Agent& agent, auto& body) { return agent.sense(t, {&y(t - 1, i), 1}, body); });
    for (int round = 0; round < agents.front()->rounds(); ++round) {
      wire::Letter letter{"saturation", 0, {kLiar, t, round}, kAgents, agents[0]->fields(kLiar, t),
                          sent[kLiar]};
      auto estimate = std::get<std::vector<double>>(letter.values().front());
      for (double& one : estimate) one += kOffset;
      const auto lie = letter.with(letter.fields.front().name, estimate).body;
      for (int i = 0; i < kAgents; ++i)
        for (const int j : network.neighbours(i))
          REQUIRE(agents[static_cast<std::size_t>(i)]->deliver(
                      {j, t, round}, j == kLiar ? lie : sent[static_cast<std::size_t>(j)]) == Refusal::none);
      for (int i = 0; i < kAgents; ++i) speak(i, [&](Agent& agent, auto& body) { return agent.fuse(body); });
    }
    for (int i = 0; i < kAgents; ++i) {
      const double bound = agents[static_cast<std::size_t>(i)]->report().bound;
      const double engine = record.bound[static_cast<std::size_t>(t * kAgents + i)];
      CHECK(std::memcmp(&bound, &engine, sizeof bound) == 0);
    }
  }
}
