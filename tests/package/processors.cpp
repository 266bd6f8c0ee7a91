// SPDX-License-Identifier: Apache-2.0
// What must have the same bytes on every processor: bodies of messages, snapshots, and the estimates of
// agents that carry their gains. Prints them; processors.sh compares. Headers alone.
#include <cstdio>
#include <vector>

#include "garrison/engine/agent_of.hpp"
#include "garrison/filters/lfre.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/platoon/vehicle.hpp"
#include "garrison/filters/rdkf/filter.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/filters/structural/filter.hpp"

using namespace garrison;

namespace {

void print(const char* what, std::span<const std::byte> bytes) {
  std::printf("%s ", what);
  for (const std::byte b : bytes) std::printf("%02x", std::to_integer<unsigned>(b));
  std::printf("\n");
}

/// Its body, and again after a way back.
template <class Message>
void round_trip(const char* family, Message message, int agents) {
  std::vector<std::byte> body(wire::most_bytes(message, agents));
  body.resize(wire::encode(message, agents, body.data()));
  print(family, body);
  Message other = message;
  std::vector<std::byte> again(wire::most_bytes(message, agents));
  const bool taken = wire::decode(body, agents, other) == Refusal::none;
  again.resize(wire::encode(other, agents, again.data()));
  std::printf("%s %s\n", family, taken && again == body ? "comes back" : "IS LOST");
}

void bodies() {
  Saturation::Message<2> s{Vec<2>(1.0 / 3.0, -0.0), true, {}, AgentSet(11)};
  s.proved.insert(2);
  s.proved.insert(10);
  round_trip("saturation", s, 11);
  Structural::Message<2> t;
  t.numbers = Vec<3>(1e-300, -7.25, 0.1);
  t.measured = true;
  t.rest = 517;
  round_trip("structural", t, 11);
  Rdkf::Message<2> r;
  r.z = Vec<2>(1e149, 2.0);
  round_trip("rdkf", r, 11);
  r.bound = 0.7;
  round_trip("rdkf", r, 11);
  PartialSharing::Message<4> p;
  p.count = 2;
  p.value = {3.5, -1.0 / 7.0, 0.0, 0.0};
  round_trip("partial_sharing", p, 11);
  round_trip("lfre", Lfre::Message<2>{Vec<2>(5.0, 6.0)}, 11);
  platoon::VehicleMessage v;
  for (int k = 0; k < 6; ++k) v.numbers[k] = 0.1 * k;
  v.bound = 2.5;
  v.has_y = true;
  v.sets = {LabelSet(4), LabelSet(4), LabelSet(4)};
  v.sets.attacked.insert(3);
  v.sets.free.unite_all_but(v.sets.attacked.listed());
  round_trip("platoon", v, 300);
}

/// 2000 samples of two saturation agents, all from plain arithmetic.
void estimates() {
  auto gains = std::make_shared<Saturation::Gains>();
  gains->alpha = 0.3;
  gains->rounds = 3;
  gains->beta = 0.5;
  std::vector<std::unique_ptr<Agent>> agents;
  for (int i = 0; i < 2; ++i) {
    AgentPart part{i, 2, Matrix(2, 2), Matrix(2, 1), {1 - i}, 42};
    part.A << 0.9, -0.2, 0.3, 0.95;
    part.C_transposed << (i == 0 ? 1.0 : 0.6), (i == 0 ? 0.0 : 0.8);
    agents.push_back(std::make_unique<AgentOf<Saturation, 2>>(gains, part));
  }
  std::vector<std::byte> body[2];
  for (auto& b : body) b.resize(agents[0]->most_bytes());
  std::uint64_t random = 1;
  for (int t = 1; t <= 2000; ++t) {
    for (std::size_t i = 0; i < 2; ++i) {
      random = random * 6364136223846793005U + 1442695040888963407U;
      const double y = static_cast<double>(random >> 40) / 16777216.0 - 0.5;
      agents[i]->sense(t, {&y, 1}, body[i]);
    }
    for (int round = 0; round < 3; ++round) {
      for (int i = 0; i < 2; ++i)
        agents[static_cast<std::size_t>(i)]->deliver({1 - i, t, round}, body[1 - i]);
      for (std::size_t i = 0; i < 2; ++i) agents[i]->fuse(body[i]);
    }
  }
  for (const auto& agent : agents) {
    std::vector<std::byte> snapshot(agent->snapshot_bytes());
    agent->save(snapshot);
    print("snapshot", snapshot);
  }
}

}  // namespace

int main() {
  bodies();
  estimates();
}
