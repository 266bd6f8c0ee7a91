// SPDX-License-Identifier: Apache-2.0
#include "simulation.hpp"

#include <cstdio>
#include <functional>
#include <string_view>

#include "station.hpp"

namespace garrison::node::test {

std::uint64_t digest(Bytes bytes) {
  return std::hash<std::string_view>{}({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Simulation::Simulation(std::uint64_t seed, Totals& totals, bool verbose, Weather weather)
    : seed_(seed),
      totals_(totals),
      verbose_(verbose),
      random_(seed * 77777 + 5),
      prepared_(shared_design(kAgents)),
      schedule_{.start = 1'000'000},
      faults_(kAgents, random_, weather),
      plant_(prepared_->model(), faults_, kSamples + 2, seed, random_),
      weather_(weather) {
  prologue_.fill(std::byte{7});
  Seeded for_keys(1);
  for (int i = 0; i < kAgents; ++i) keys_.push_back(key_pair(for_keys.key()));
  const bool all_sign = weather == Weather::liar || weather == Weather::honest;
  if (all_sign || (weather == Weather::all && seed % 5 == 1))
    for (int i = 0; i < kAgents; ++i) {
      signing_open_.emplace_back();
      signing_.push_back(signing_key(for_keys.key(), signing_open_.back()));
    }
  for (int i = 0; i < kAgents; ++i) {
    stations_.push_back(std::make_unique<Station>(*this, i));
    boot(i);
    push(1000 + 100 * i, Event::What::tick, i);
  }
  for (const Faults::Crash& c : faults_.crashes) {
    push(c.at, Event::What::crash, c.node, nullptr, Event::Mark::genuine, c.lost ? 1 : 0);
    push(c.back, Event::What::restart, c.node);
  }
  for (const Faults::Step& step : faults_.steps)
    push(step.at, Event::What::step, step.node, nullptr, Event::Mark::genuine, step.by);
}
Simulation::~Simulation() = default;

void Simulation::push(Micros at, Event::What what, int node, std::shared_ptr<const Octets> bytes,
                      Event::Mark mark, Micros by) {
  queue_.push({at, order_++, what, node, mark, std::move(bytes), by});
}

void Simulation::run() {
  const Micros end = schedule_.begin(kSamples - 1);
  bool calm = false;
  while (!queue_.empty() && queue_.top().at < end) {
    const Event event = queue_.top();
    queue_.pop();
    now_ = event.at;
    ++totals_.events;
    if (!calm && now_ >= schedule_.begin(kQuiet)) {
      calm = true;
      for (int i = 0; i < kAgents; ++i)
        if (!stations_[static_cast<std::size_t>(i)]->up()) boot(i);
    }
    happen(event);
  }
  finish();
}

void Simulation::happen(const Event& event) {
  Station& station = *stations_[static_cast<std::size_t>(event.node)];
  switch (event.what) {
    case Event::What::tick: {
      Micros next = now_ + kPoll;
      if (station.up()) {
        station.tick();
        const Micros due = station.node().due() - station.clock().wall + now_;
        if (due > now_) next = std::min(next, due);
      }
      return push(next, Event::What::tick, event.node);
    }
    case Event::What::datagram:
      if (station.up()) receive(station, event);
      return;
    case Event::What::crash:
      ++totals_.crashes;
      return station.crash(event.by != 0);
    case Event::What::restart:
      if (!station.up()) boot(event.node);
      return;
    case Event::What::step:
      station.step += event.by;
      if (station.step == 0) right_at_ = now_;
  }
}

void Simulation::receive(Station& station, const Event& event) {
  const Fate fate = station.receive(*event.bytes);
  // Frames that were opened, whatever the core said of them, and answered handshakes.
  const bool opened = fate == Fate::taken || fate >= Fate::kind;
  totals_.refused += fate != Fate::taken && fate != Fate::handshake;
  if (event.mark == Event::Mark::mutated && (opened || fate == Fate::handshake))
    wrong(totals_.mutants_wrong, "a mutated datagram was taken", event.node);
  if (opened && !station.taken.insert(digest(*event.bytes)).second)
    wrong(totals_.taken_twice_wrong, "a datagram was taken twice", event.node);
}

void Simulation::send(int from, int to, Bytes datagram) {
  ++totals_.datagrams;
  const auto bytes = std::make_shared<const Octets>(datagram.begin(), datagram.end());
  if (now_ >= schedule_.begin(kQuiet)) return push(now_ + 300, Event::What::datagram, to, bytes);
  if (captured_.size() < 4000) captured_.emplace_back(to, bytes);
  if (cut(from, to) || random_.uniform() < faults_.loss) return;
  const auto late = [&](double times) {
    return now_ + 200 + static_cast<Micros>(times * static_cast<double>(faults_.jitter) * random_.uniform());
  };
  push(late(1), Event::What::datagram, to, bytes);
  if (random_.uniform() < faults_.duplicates)
    push(late(3) + 1, Event::What::datagram, to, bytes, Event::Mark::copied);
  trouble();
}

/// An attacker on the wire: what was captured comes again, here or elsewhere, or changed.
void Simulation::trouble() {
  const auto soon = [&] { return now_ + static_cast<Micros>(20000 * random_.uniform()); };
  if (random_.uniform() < faults_.inject) {
    const auto& [to, old] = captured_[random_.below(captured_.size())];
    ++totals_.injected;
    const int target = random_.uniform() < 0.7 ? to : static_cast<int>(random_.below(kAgents));
    push(soon(), Event::What::datagram, target, old, Event::Mark::copied);
  }
  if (random_.uniform() < faults_.mutate) {
    const auto& [to, old] = captured_[random_.below(captured_.size())];
    ++totals_.mutated;
    push(soon(), Event::What::datagram, to, std::make_shared<const Octets>(mutated(*old, random_)),
         Event::Mark::mutated);
  }
}

bool Simulation::cut(int from, int to) const {
  for (const Faults::Cut& c : faults_.cuts) {
    const bool hit =
        c.receiver < 0 ? c.sender == from || c.sender == to : c.sender == from && c.receiver == to;
    if (hit && now_ >= c.from && now_ < c.to) return true;
  }
  return false;
}

void Simulation::boot(int node) { stations_[static_cast<std::size_t>(node)]->boot(); }

void Simulation::wrong(std::int64_t& counter, const char* what, int node, std::int64_t sample) {
  ++counter;
  if (verbose_)
    std::printf("  seed %llu, node %d, sample %lld: %s\n", static_cast<unsigned long long>(seed_), node,
                static_cast<long long>(sample), what);
}

}  // namespace garrison::node::test
