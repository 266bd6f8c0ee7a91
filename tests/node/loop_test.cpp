// SPDX-License-Identifier: Apache-2.0
// The loop of the daemon over real sockets of 127.0.0.1: three nodes in one process, with the bits of the
// plain loop, and without memory from the heap.
#include "node/daemon/loop.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "allocations.hpp"
#include "folder.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/design_file.hpp"

using namespace garrison;
using namespace garrison::node;
using namespace garrison::node::test;

namespace {

constexpr int kNodes = 3;

std::shared_ptr<const Prepared> design() {
  Matrix A = 0.95 * Matrix::Identity(2, 2);
  A(0, 1) = 0.1;
  std::vector<Matrix> C;
  for (int i = 0; i < kNodes; ++i) C.push_back(Matrix::Identity(2, 2).row(i % 2));
  Noise noise;
  noise.process_bound = 0.02;
  noise.measurement_bound = Vector::Constant(kNodes, 0.01);
  const ParamMap params{{"threshold", 0.5}, {"rounds", std::int64_t{2}}};
  return make_filter("saturation", params)->prepare(Model(A, C, noise), Network::complete(kNodes));
}

/// A port of 127.0.0.1 that nobody listens at just now.
int free_port() {
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof any;
  REQUIRE(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&any), size) == 0);
  REQUIRE(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&any), &size) == 0);
  return ntohs(any.sin_port);
}

/// One node with what lies around it, from files.
struct Running {
  Running(const std::string& path, std::uint64_t boot)
      : station(read_station(path)),
        udp("test", station.settings.listen, 1 << 20),
        sensor(station.settings.sensor, 1, path),
        ring(1 << 22),
        loop(station, boot, udp, sensor, ring) {}

  Station station;
  Udp udp;
  Sensor sensor;
  Ring ring;
  Loop loop;
  std::int64_t allocated = 0;
};

class Network3 {
 public:
  explicit Network3(Micros start) : prepared_(design()) {
    std::ofstream roster(folder_ / "roster.toml");
    roster << "[run]\nstart = " << start << "\nperiod_ms = 40\ninitial = [1, 0]\n";
    for (int i = 0; i < kNodes; ++i) {
      const std::string name = "n" + std::to_string(i);
      const Identity identity = identity_of(random_seed());
      write_key(folder_ / (name + ".key"), identity);
      replace_file(folder_ / (name + ".part"), write_part(*prepared_, i));
      const int port = free_port();
      roster << "[[agent]]\nid = " << i << "\nname = \"" << name << "\"\nkey = \"" << base64(identity.open)
             << "\"\naddress = \"127.0.0.1:" << port << "\"\n";
      std::ofstream(folder_ / (name + ".csv")) << "1\n0.5\n0.25\n0\nnan\n-1\n";
      std::ofstream(folder_ / (name + ".toml"))
          << "name = \"" << name << "\"\npart = \"" << name << ".part\"\nroster = \"roster.toml\"\nkey = \""
          << name << ".key\"\n[listen]\naddress = \"127.0.0.1:" << port
          << "\"\n[sensor]\nsource = \"file\"\npath = \"" << name << ".csv\"\n";
    }
  }
  std::string settings(int i) const { return folder_ / ("n" + std::to_string(i) + ".toml"); }

 private:
  Folder folder_;
  std::shared_ptr<const Prepared> prepared_;
};

}  // namespace

TEST_CASE("three loops over sockets: complete, replayed to the bit, and no memory from the heap") {
  const std::int64_t nothing = allocations();
  const Micros start = garrison::node::now().wall + 300'000;
  const Network3 network(start);
  std::vector<std::unique_ptr<Running>> nodes;
  for (int i = 0; i < kNodes; ++i) nodes.push_back(std::make_unique<Running>(network.settings(i), 1));
  if (kAllocationsCounted) CHECK(allocations() > nothing);
  std::vector<std::thread> threads;
  for (auto& node : nodes) {
    node->loop.begin({});
    threads.emplace_back([&node] {
      const std::int64_t before = allocations();
      node->loop.run();
      node->allocated = allocations() - before;
    });
  }
  ::usleep(static_cast<useconds_t>(std::max<Micros>(0, start + 40'000 * 22 - garrison::node::now().wall)));
  for (auto& node : nodes) node->loop.end();
  for (std::thread& thread : threads) thread.join();

  for (auto& node : nodes) {
    CHECK(node->allocated == 0);
    const auto agent = read_part(node->station.part);
    Replay replay(*agent);
    std::int64_t samples = 0, snapshots = 0;
    std::vector<std::byte> room;
    while (node->ring.take(room, [&](std::uint8_t kind, Bytes content) {
      Entry entry;
      std::size_t size = 0;
      if (static_cast<Note>(kind) == Note::call && read_entry(content.subspan(8), entry, size)) replay(entry);
      snapshots += static_cast<Note>(kind) == Note::snapshot ? 1 : 0;
      Status status;
      if (static_cast<Note>(kind) == Note::status && status.read(content, 2, 2))
        samples += status.head.ended ? 1 : 0;
    })) {
    }
    CHECK(samples >= 3);  // all 22 unless the machine is busy
    CHECK(replay.estimates() == samples);
    CHECK(replay.wrong() == 0);
    CHECK(snapshots >= 1);
  }
}

TEST_CASE("a log that begins anew replays, too: a snapshot, and the messages that were early") {
  const Micros start = garrison::node::now().wall + 300'000;
  const Network3 network(start);
  std::vector<std::unique_ptr<Running>> nodes;
  std::vector<std::thread> threads;
  for (int i = 0; i < kNodes; ++i) nodes.push_back(std::make_unique<Running>(network.settings(i), 1));
  for (auto& node : nodes) {
    node->loop.begin({});
    threads.emplace_back([&node] { node->loop.run(); });
  }
  for (int turns = 0; turns < 20; ++turns) {
    ::usleep(50'000);
    for (auto& node : nodes) node->loop.ask_fresh();
  }
  for (auto& node : nodes) node->loop.end();
  for (std::thread& thread : threads) thread.join();

  for (auto& node : nodes) {
    std::int64_t logs = 1, estimates = 0, wrong = 0;
    auto agent = read_part(node->station.part);
    auto replay = std::make_unique<Replay>(*agent);
    const auto finish = [&] {
      estimates += replay->estimates();
      wrong += replay->wrong();
    };
    std::vector<std::byte> room;
    while (node->ring.take(room, [&](std::uint8_t kind, Bytes content) {
      Entry entry;
      std::size_t size = 0;
      if (static_cast<Note>(kind) == Note::fresh) {
        finish();
        agent = read_part(node->station.part);
        replay = std::make_unique<Replay>(*agent);
        ++logs;
      }
      if (static_cast<Note>(kind) == Note::call && read_entry(content.subspan(8), entry, size))
        (*replay)(entry);
    })) {
    }
    finish();
    CHECK(logs > 2);
    CHECK(estimates > 3);
    CHECK(wrong == 0);
  }
}
