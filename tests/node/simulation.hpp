// SPDX-License-Identifier: Apache-2.0
// The whole network in virtual time: the nodes of the daemon, seeded faults, and what must hold whatever
// happens.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <set>
#include <unordered_set>
#include <vector>

#include "garrison/engine/any_filter.hpp"
#include "garrison/node/node.hpp"
#include "hostile.hpp"

namespace garrison::node::test {

/// What a run has shown; every `*_wrong` must be 0.
struct Totals {
  std::int64_t seeds = 0, events = 0, datagrams = 0, samples = 0, complete = 0, missing = 0, wants = 0,
               resent = 0;
  std::int64_t injected = 0, mutated = 0, refused = 0, conflicts = 0, crashes = 0, joins = 0, clock_steps = 0;
  std::int64_t taken_twice_wrong = 0;  ///< a datagram accepted a second time
  std::int64_t mutants_wrong = 0;      ///< a changed one accepted
  std::int64_t fused = 0,
               fused_wrong = 0;  ///< bodies that their sender did not produce for that sample and round
  std::int64_t bodies = 0, bodies_wrong = 0;          ///< samples and rounds with two bodies of one node
  std::int64_t estimates = 0, estimates_wrong = 0;    ///< not finite
  std::int64_t bounds = 0, bounds_wrong = 0;          ///< errors beyond a reported bound
  std::int64_t proofs = 0, proofs_wrong = 0;          ///< node-samples that hold an honest sensor for proved
  std::int64_t nodes = 0, nodes_wrong = 0;            ///< not back with all links at the end
  std::int64_t convictions = 0;                       ///< of liars who signed two things, by one node each
  std::int64_t statements = 0, statements_wrong = 0;  ///< of honest nodes that seemed to contradict something
  std::int64_t replayed = 0, replayed_wrong = 0;
  std::int64_t plain = 0, plain_wrong = 0;  ///< compared with the agents driven by a plain loop

  std::int64_t wrong() const {
    return taken_twice_wrong + mutants_wrong + fused_wrong + bodies_wrong + estimates_wrong + bounds_wrong +
           proofs_wrong + statements_wrong + nodes_wrong + replayed_wrong + plain_wrong;
  }
};

/// Drawn from the seed.
struct Faults {
  double loss = 0, duplicates = 0, inject = 0, mutate = 0;
  Micros jitter = 0;
  int liar = -1;
  std::optional<int> attacked;
  std::vector<Micros> skew;
  struct Cut {
    Micros from, to;
    int sender, receiver;  ///< receiver -1: nothing reaches or leaves the sender
  };
  std::vector<Cut> cuts;
  struct Crash {
    Micros at, back;
    int node;
    bool lost;  ///< its snapshot
  };
  std::vector<Crash> crashes;
  struct Step {
    Micros at, by;
    int node;
  };
  std::vector<Step> steps;  ///< of a node's clock

  Faults(int agents, Seeded& random);
  bool none() const { return loss == 0 && cuts.empty() && crashes.empty() && steps.empty() && liar < 0; }
};

class Simulation {
 public:
  Simulation(std::uint64_t seed, Totals& totals, bool verbose = false);
  ~Simulation();
  void run();

 private:
  static constexpr int kAgents = 8;
  static constexpr int kSamples = 100;
  /// From here on nothing goes wrong any more: longer than it takes to doubt a silent link and to open it
  /// again (Peer::kSilence + Peer::kRetryLive).
  static constexpr int kQuiet = 70;
  static constexpr Micros kPoll = 5000;

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

  void make_plant();
  void push(Micros at, Event::What what, int node, std::shared_ptr<const Octets> bytes = nullptr,
            Event::Mark mark = Event::Mark::genuine, Micros by = 0);
  void happen(const Event& event);
  void receive(Station& station, const Event& event);
  void send(int from, int to, Bytes datagram);
  void trouble();
  bool cut(int from, int to) const;
  void boot(int node);
  void check_sample(int node, const Sample& sample);
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
  std::vector<KeyPair> keys_;
  std::vector<SigningKey> signing_;  ///< empty: nobody signs
  std::vector<Key> signing_open_;
  Prologue prologue_{};
  Vector x0_;
  std::vector<Vector> states_;
  std::vector<std::vector<double>> measurements_;  ///< [sample][agent]
  std::vector<std::unique_ptr<Station>> stations_;
  std::priority_queue<Event> queue_;
  std::uint64_t order_ = 0;
  Micros now_ = 0;
  std::vector<std::pair<int, std::shared_ptr<const Octets>>> captured_;
};

}  // namespace garrison::node::test
