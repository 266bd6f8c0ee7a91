// SPDX-License-Identifier: Apache-2.0
// garrison_node_latency [NODES [ROUNDS]]: rounds of N processes on a ring, each of which sends 61 bytes to
// the four nearest and waits for theirs: over raw datagrams, over ours (sealed), and over ZeroMQ with CURVE
// where libzmq was there at the build. In turn, so that the load of the machine is the same for all. Ends
// with 1 when ours take more than half of CURVE's time for a round, or more than 1.3 times that of raw
// datagrams.
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "mesh.hpp"

using namespace garrison::node;
using namespace garrison::node::test;

namespace {

constexpr int kTurns = 21;
constexpr double kMostOfCurve = 0.5, kMostOfRaw = 1.3;

/// What the processes of a turn share.
struct Shared {
  std::atomic<int> ready{0};
  std::atomic<Micros> took{0};  ///< microseconds, of the slowest
  std::atomic<Micros> cpu{0};   ///< microseconds, of all
  std::atomic<int> failed{0};
};

Micros cpu_used() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return 1'000'000 * (used.ru_utime.tv_sec + used.ru_stime.tv_sec) + used.ru_utime.tv_usec +
         used.ru_stime.tv_usec;
}

/// One process: all rounds.
bool take_part(Mesh& mesh, int neighbours, int nodes, int rounds, Shared& shared) {
  if (!mesh.open()) return false;
  shared.ready.fetch_add(1);
  while (shared.ready.load() < nodes) ::usleep(100);
  const Micros begun = garrison::node::now().steady, used = cpu_used();
  std::vector<int> heard(static_cast<std::size_t>(rounds) + 1, 0);
  for (int round = 0; round < rounds; ++round) {
    mesh.send(round);
    while (heard[static_cast<std::size_t>(round)] < neighbours) {
      const int of = mesh.receive();
      if (of < 0 || of > rounds) return false;
      ++heard[static_cast<std::size_t>(of)];
    }
  }
  const Micros took = garrison::node::now().steady - begun;
  for (Micros seen = shared.took.load(); seen < took && !shared.took.compare_exchange_weak(seen, took);) {
  }
  shared.cpu.fetch_add(cpu_used() - used);
  shared.ready.fetch_add(1);
  while (shared.ready.load() < 2 * nodes) ::usleep(1000);  // late ones are still answered by ZeroMQ's threads
  return true;
}

struct Turn {
  double round = 0;    ///< microseconds
  double message = 0;  ///< microseconds of CPU
};

Turn turn(Mesh::Kind kind, int nodes, int rounds) {
  void* const place =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* shared = new (place) Shared;
  const auto plan = MeshPlan::of(nodes);
  std::vector<pid_t> children;
  for (int i = 0; i < nodes; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::alarm(120);
      auto mesh = Mesh::of(kind, *plan, i);
      const int neighbours = static_cast<int>(plan->neighbours(i).size());
      const bool well = mesh && take_part(*mesh, neighbours, nodes, rounds, *shared);
      if (!well) shared->failed.fetch_add(1);
      ::_exit(well ? 0 : 1);
    }
    children.push_back(child);
  }
  bool well = true;
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    well = well && status == 0;
  }
  const double messages =
      static_cast<double>(rounds) * nodes * static_cast<double>(plan->neighbours(0).size());
  const Turn out = well ? Turn{static_cast<double>(shared->took.load()) / rounds,
                               static_cast<double>(shared->cpu.load()) / messages}
                        : Turn{};
  ::munmap(place, sizeof(Shared));
  return out;
}

/// Of turns that followed each other, so that both had the same load beside them.
double ratio(const std::vector<double>& some, const std::vector<double>& others) {
  std::vector<double> all;
  for (std::size_t k = 0; k < some.size(); ++k) all.push_back(some[k] / others[k]);
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}
double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int count, char** words) {
  const int nodes = count > 1 ? std::atoi(words[1]) : 10, rounds = count > 2 ? std::atoi(words[2]) : 1000;
  if (nodes < 2 || nodes > 64 || rounds < 1 || rounds > 1'000'000 || !start_crypto())
    return std::fputs("usage: garrison_node_latency [NODES [ROUNDS]]\n", stderr), 2;
  std::map<Mesh::Kind, std::vector<double>> round, message;
  for (int k = 0; k < kTurns; ++k)
    for (const Mesh::Kind kind : Mesh::kinds()) {
      const Turn found = turn(kind, nodes, rounds);
      if (found.round == 0)
        return std::printf("%s: a process ended, or a datagram was lost\n", Mesh::word(kind)), 1;
      round[kind].push_back(found.round);
      message[kind].push_back(found.message);
    }
  for (const Mesh::Kind kind : Mesh::kinds())
    std::printf("%-7s %2d processes: %7.0f us a round (median of %d turns), %5.2f us of CPU a message\n",
                Mesh::word(kind), nodes, middle(round[kind]), kTurns, middle(message[kind]));
  const auto& ours = round[Mesh::Kind::sealed];
  const double of_raw = ratio(ours, round[Mesh::Kind::raw]);
  bool met = of_raw <= kMostOfRaw;
  std::printf("sealed: %.2f of raw datagrams (1.3 allowed)", of_raw);
  if (round.count(Mesh::Kind::curve) != 0) {
    const double of_curve = ratio(ours, round[Mesh::Kind::curve]);
    met = met && of_curve <= kMostOfCurve;
    std::printf(", %.2f of ZeroMQ CURVE (0.5 allowed)\n", of_curve);
  } else {
    met = false;
    std::printf(
        "; ZeroMQ left out, so nothing is judged: apt-get install libzmq3-dev, and configure again\n");
  }
  return met ? 0 : 1;
}
