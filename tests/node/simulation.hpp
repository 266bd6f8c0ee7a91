// SPDX-License-Identifier: Apache-2.0
// The whole network in virtual time: the nodes of the daemon, seeded faults, and what must hold whatever
// happens.
#pragma once

#include <map>
#include <memory>
#include <queue>
#include <set>
#include <unordered_set>
#include <vector>

#include "garrison/node/node.hpp"
#include "plant.hpp"
#include "totals.hpp"

namespace garrison::node::test {

/// By which bodies and datagrams are told apart; quick, as nobody here looks for two with the same.
std::uint64_t digest(Bytes bytes);

class Simulation {
 public:
  Simulation(std::uint64_t seed, Totals& totals, bool verbose = false, Weather weather = Weather::all);
  ~Simulation();
  void run();

 private:
  static constexpr int kAgents = 8;
  static constexpr int kSamples = 100;
  /// From here on nothing goes wrong any more: longer than it takes to doubt a silent link and to open it
  /// again (Peer::kSilence + Peer::kRetryLive).
  static constexpr int kQuiet = 70;
  static constexpr Micros kPoll = 5000;
  static constexpr int kBatch = 10;  ///< samples that a statement is about

  struct Event {
    enum class What { tick, datagram, crash, restart, step };
    Micros at;
    std::uint64_t order;
    What what;
    int node;
    enum class Mark { genuine, copied, mutated } mark;
    std::shared_ptr<const Octets> bytes;
    Micros by;
    bool operator<(const Event& other) const { return at != other.at ? at > other.at : order > other.order; }
  };
  class Station;

  void push(Micros at, Event::What what, int node, std::shared_ptr<const Octets> bytes = nullptr,
            Event::Mark mark = Event::Mark::genuine, Micros by = 0);
  void happen(const Event& event);
  void receive(Station& station, const Event& event);
  void send(int from, int to, Bytes datagram);
  void trouble();
  bool cut(int from, int to) const;
  void boot(int node);
  void check_sample(int node, const Sample& sample);
  void check_clock(int node, const Sample& sample);
  void convicted(int node);
  void finish();
  void check_bodies();
  void check_plain_loop();
  void wrong(std::int64_t& counter, const char* what, int node, std::int64_t sample = -1);

  std::uint64_t seed_;
  Totals& totals_;
  bool verbose_;
  Seeded random_;
  std::shared_ptr<const Prepared> prepared_;
  Schedule schedule_;
  Faults faults_;
  Plant plant_;
  Weather weather_;
  std::vector<KeyPair> keys_;
  std::vector<SigningKey> signing_;  ///< empty: nobody signs
  std::vector<Key> signing_open_;
  Prologue prologue_{};
  std::vector<std::unique_ptr<Station>> stations_;
  std::priority_queue<Event> queue_;
  std::uint64_t order_ = 0;
  Micros now_ = 0;
  Micros right_at_ =
      -1;  ///< the stepped clock was right again; -1 = nobody's, or a complete sample came of it
  Micros lied_at_ = -1;      ///< the first statement that was not shown to all alike
  std::set<int> convicted_;  ///< nodes that had a proof in time
  std::vector<std::pair<int, std::shared_ptr<const Octets>>> captured_;
};

}  // namespace garrison::node::test
