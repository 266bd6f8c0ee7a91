// SPDX-License-Identifier: Apache-2.0
// What must hold of a simulated run: sample by sample, and at its end from the logs.
#include "simulation.hpp"
#include "station.hpp"

namespace garrison::node::test {

/// Three samples after its clock is right again, a node has a complete one.
void Simulation::check_clock(int node, const Sample& sample) {
  if (weather_ != Weather::clock || right_at_ < 0 || node != faults_.steps.front().node) return;
  const bool late = sample.sample > schedule_.slot(right_at_) + 3;
  if (!sample.complete && !late) return;
  right_at_ = -1;
  ++totals_.steps;
  if (late)
    wrong(totals_.steps_wrong, "a clock was right again, and no complete sample came of it", node,
          sample.sample);
}

/// A node has a proof against the liar.
void Simulation::convicted(int node) {
  ++totals_.convictions;
  if (now_ - lied_at_ <= 3 * kBatch * schedule_.period) convicted_.insert(node);
}

void Simulation::check_sample(int node, const Sample& sample) {
  check_clock(node, sample);
  Agent& agent = stations_[static_cast<std::size_t>(node)]->agent();
  Vector x(2);
  agent.estimate({x.data(), 2});
  ++totals_.estimates;
  if (!x.allFinite()) wrong(totals_.estimates_wrong, "an estimate is not finite", node, sample.sample);
  if (faults_.liar >= 0) return;  // bounds and proofs are of sensors that lie, not of senders
  if (std::isfinite(sample.report.bound) && sample.sample < static_cast<std::int64_t>(plant_.states.size())) {
    ++totals_.bounds;
    const double error = (x - plant_.states[static_cast<std::size_t>(sample.sample)]).norm();
    if (error > sample.report.bound * (1 + 1e-9))
      wrong(totals_.bounds_wrong, "an error is beyond its bound", node, sample.sample);
  }
  ++totals_.proofs;
  for (const int j : agent.accused())
    if (j != faults_.attacked)
      return wrong(totals_.proofs_wrong, "an honest sensor is proved", node, sample.sample);
}

void Simulation::finish() {
  ++totals_.seeds;
  for (int i = 0; i < kAgents; ++i) {
    Station& station = *stations_[static_cast<std::size_t>(i)];
    station.count();
    ++totals_.nodes;
    bool back = station.up() && station.agent().sample() >= kSamples - 3;
    for (std::size_t k = 0; back && k < station.node().links(); ++k) {
      const LinkView link = station.node().link(k, station.clock());
      back = link.up && !link.absent;
    }
    if (!back) wrong(totals_.nodes_wrong, "not back at the end", i, station.agent().sample());
  }
  check_bodies();
  if (weather_ == Weather::liar) {
    ++totals_.equivocations;
    if (convicted_.size() < 2)
      wrong(totals_.equivocations_wrong, "two statements, and no two nodes with a proof in time",
            faults_.liar);
  }
  if (right_at_ >= 0 && weather_ == Weather::clock)
    wrong(totals_.steps_wrong, "a clock was right again, and no sample came of it",
          faults_.steps.front().node);
  if (faults_.none()) check_plain_loop();
}

/// From the logs alone: what every node produced, and that nothing else was fused.
void Simulation::check_bodies() {
  std::map<std::tuple<int, std::int64_t, int>, std::set<std::uint64_t>> produced;
  for (int i = 0; i < kAgents; ++i)
    for (const Octets& log : stations_[static_cast<std::size_t>(i)]->logs()) {
      const auto agent = prepared_->agent(i);
      Replay replay(*agent, [&](std::int64_t t, int round, Bytes body) {
        produced[{i, t, round}].insert(digest(body));
      });
      if (!replay.all(log)) wrong(totals_.replayed_wrong, "a log is cut", i);
      totals_.replayed += replay.estimates();
      if (replay.wrong() != 0) wrong(totals_.replayed_wrong, "a log gives other estimates", i);
    }
  for (const auto& [place, bodies] : produced) {
    ++totals_.bodies;
    if (bodies.size() > 1)
      wrong(totals_.bodies_wrong, "two bodies for one round", std::get<0>(place), std::get<1>(place));
  }
  for (int i = 0; i < kAgents; ++i)
    for (const Octets& log : stations_[static_cast<std::size_t>(i)]->logs()) {
      Bytes rest = log;
      Entry entry;
      for (std::size_t size = 0; read_entry(rest, entry, size); rest = rest.subspan(size)) {
        if (entry.call != Call::deliver || entry.sender == faults_.liar) continue;
        ++totals_.fused;
        if (produced[{entry.sender, entry.sample, entry.round}].count(digest(entry.data)) == 0)
          wrong(totals_.fused_wrong, "a body that its sender did not produce", i, entry.sample);
      }
    }
}

void Simulation::check_plain_loop() {
  std::vector<std::map<std::int64_t, Octets>> found(kAgents);
  for (std::size_t i = 0; i < kAgents; ++i) {
    if (stations_[i]->missed()) return;
    Bytes rest = stations_[i]->logs().front();
    Entry entry;
    for (std::size_t size = 0; read_entry(rest, entry, size); rest = rest.subspan(size))
      if (entry.call == Call::estimate) found[i][entry.sample] = {entry.data.begin(), entry.data.end()};
  }
  std::vector<std::unique_ptr<Agent>> agents;
  for (int i = 0; i < kAgents; ++i) {
    agents.push_back(prepared_->agent(i));
    agents.back()->reset(plant_.x0);
  }
  std::vector<Octets> bodies(kAgents, Octets(agents[0]->most_bytes()));
  for (std::int64_t t = 1; t < kSamples - 1; ++t) {
    const auto& y = plant_.measurements[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < kAgents; ++i) agents[i]->sense(t, {&y[i], 1}, bodies[i]);
    for (int round = 0; round < agents[0]->rounds(); ++round) {
      for (const auto& agent : agents)
        for (const int j : agent->neighbours())
          agent->deliver({j, t, round}, bodies[static_cast<std::size_t>(j)]);
      for (std::size_t i = 0; i < kAgents; ++i) agents[i]->fuse(bodies[i]);
    }
    for (std::size_t i = 0; i < kAgents; ++i) {
      if (found[i].count(t) == 0) continue;
      std::array<double, 2> x{};
      agents[i]->estimate(x);
      Octets expected(16);
      write_numbers(x, expected.data());
      ++totals_.plain;
      if (found[i][t] != expected)
        wrong(totals_.plain_wrong, "another estimate than the plain loop's", static_cast<int>(i), t);
    }
  }
}

}  // namespace garrison::node::test
