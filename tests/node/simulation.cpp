// SPDX-License-Identifier: Apache-2.0
#include "simulation.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace garrison::node::test {

namespace {
std::uint64_t digest(Bytes bytes) {
  std::array<std::byte, 16> made;
  hash({}, {bytes}, made);
  return wire::load<std::uint64_t>(made.data());
}
Vector direction(double angle) { return Vector{{std::cos(angle), std::sin(angle)}}; }
double signed_unit(Seeded& random) { return 2 * random.uniform() - 1; }

/// A turning plant, sensors all around, neighbours at distance one and two on a ring.
std::shared_ptr<const Prepared> design(int agents) {
  const double turn = 0.05;
  Matrix A{{std::cos(turn), -std::sin(turn)}, {std::sin(turn), std::cos(turn)}};
  A *= 0.98;
  std::vector<Matrix> C;
  std::vector<Edge> edges;
  for (int i = 0; i < agents; ++i) {
    C.push_back(direction(std::numbers::pi * i / agents).transpose());
    for (const int step : {1, 2})
      edges.emplace_back(std::min(i, (i + step) % agents), std::max(i, (i + step) % agents));
  }
  const Model model(A, C, {0.002, Vector::Constant(agents, 0.01), {}, {}});
  return make_filter("saturation", {{"threshold", 1.0},
                                    {"rounds", std::int64_t{3}},
                                    {"attacked", std::int64_t{1}},
                                    {"initial_error", 1.0},
                                    {"detector", true}})
      ->prepare(model, Network(agents, edges));
}
const std::shared_ptr<const Prepared>& shared_design(int agents) {
  static const auto made = design(agents);
  return made;
}
}  // namespace

Faults::Faults(int agents, Seeded& random) : skew(static_cast<std::size_t>(agents), 0) {
  const auto some = [&](double chance) { return random.uniform() < chance; };
  const auto anyone = [&] { return static_cast<int>(random.below(static_cast<std::size_t>(agents))); };
  const auto moment = [&](double from, double span) {
    return static_cast<Micros>(1e6 * (from + span * random.uniform()));
  };
  if (some(0.5)) loss = 0.3 * random.uniform();
  if (some(0.5)) duplicates = 0.1 * random.uniform();
  if (some(0.6)) jitter = static_cast<Micros>(15000 * random.uniform());
  if (some(0.5)) inject = 0.3 * random.uniform();
  if (some(0.5)) mutate = 0.3 * random.uniform();
  if (some(0.15)) liar = anyone();
  if (some(0.5)) attacked = anyone();
  if (some(0.5))
    for (Micros& s : skew) s = static_cast<Micros>(10000 * signed_unit(random));
  if (some(0.4))
    for (std::size_t k = 1 + random.below(4); k > 0; --k) {
      const Micros from = moment(1.5, 5);
      cuts.push_back({from, from + moment(0, 2), anyone(), some(0.3) ? -1 : anyone()});
    }
  if (some(0.4))
    for (std::size_t k = 1 + random.below(4); k > 0; --k) {
      const Micros at = moment(1.5, 6);
      crashes.push_back({at, at + moment(0, 1.5), anyone(), some(0.5)});
    }
  // A clock that is wrong for a while, by up to an hour; not of a node that also crashes: nothing remembers
  // then what was sent.
  if (some(0.3)) {
    const int node = anyone();
    const bool crashing =
        std::any_of(crashes.begin(), crashes.end(), [&](const Crash& c) { return c.node == node; });
    const Micros by =
        static_cast<Micros>(3.6e9 * std::pow(10.0, -5 * random.uniform())) * (some(0.5) ? 1 : -1);
    const Micros at = moment(2, 3);
    if (!crashing) steps = {{at, by, node}, {at + moment(0.05, 3), -by, node}};
  }
}

/// One node, its disk and its log.
class Simulation::Station final : public World, private Tamper {
 public:
  Station(Simulation& simulation, int id) : s_(simulation), id_(id) {}

  void boot() {
    ++boots_;
    node_.reset();
    agent_ = s_.prepared_->agent(id_);
    std::vector<Neighbour> neighbours;
    for (const int j : agent_->neighbours())
      neighbours.push_back({j, s_.keys_[static_cast<std::size_t>(j)].open});
    node_ = std::make_unique<Node>(*agent_, s_.schedule_, s_.keys_[static_cast<std::size_t>(id_)],
                                   std::move(neighbours), s_.prologue_, boots_, *this, s_.random_);
    if (id_ == s_.faults_.liar) node_->tamper_with(*this);
    if (!s_.signing_.empty()) sign();
    logs_.emplace_back();
    if (boots_ == 1)
      node_->core().start(s_.x0_, clock());
    else if (disk_.empty() || !node_->core().restore(disk_, clock()))
      node_->core().listen(clock());
  }
  void crash(bool lost) {
    count();
    node_.reset();
    if (lost) disk_.clear();
  }
  void sign() {
    authors_ =
        std::make_unique<Authors>(Authors::Setup{id_,
                                                 s_.signing_[static_cast<std::size_t>(id_)],
                                                 boots_,
                                                 Key{},
                                                 s_.signing_open_,
                                                 {agent_->neighbours().begin(), agent_->neighbours().end()},
                                                 agent_->rounds(),
                                                 10});
    node_->sign_with(*authors_);
  }
  void tick() {
    node_->tick(clock());
    keep_snapshot();
  }
  Fate receive(Bytes bytes) {
    const Fate fate = node_->receive(bytes, clock());
    keep_snapshot();
    return fate;
  }
  void count() {
    if (node_ == nullptr) return;
    const Core::Counters& c = node_->core().counters();
    Totals& t = s_.totals_;
    t.samples += c.samples;
    t.complete += c.complete;
    t.missing += c.missing;
    t.wants += c.wants;
    t.resent += c.resent;
    t.joins += c.joins;
    t.clock_steps += c.clock_steps;
    for (std::size_t k = 0; k < node_->links(); ++k) t.conflicts += node_->fates(k)[Fate::conflict];
    if (authors_ != nullptr) {
      t.statements += authors_->taken();
      if (s_.faults_.liar < 0) t.statements_wrong += authors_->disowned();
    }
    missed_ |= c.missing + c.missed_samples != 0;
  }
  Instant clock() const {
    return {s_.now_ + s_.faults_.skew[static_cast<std::size_t>(id_)] + step, s_.now_ + 7'000'000};
  }
  bool up() const { return node_ != nullptr; }
  Node& node() { return *node_; }
  Agent& agent() { return *agent_; }
  const std::vector<Octets>& logs() const { return logs_; }
  bool missed() const { return missed_; }

  std::unordered_set<std::uint64_t> taken;
  Micros step = 0;

 private:
  void send(int neighbour, Bytes datagram) noexcept override { s_.send(id_, neighbour, datagram); }
  void measure(std::int64_t sample, std::span<double> y) noexcept override {
    const auto& all = s_.measurements_;
    if (sample >= 0 && sample < static_cast<std::int64_t>(all.size()))
      y[0] = all[static_cast<std::size_t>(sample)][static_cast<std::size_t>(id_)];
  }
  void journal(const Entry& entry) noexcept override {
    Octets& log = logs_.back();
    const std::size_t at = log.size();
    log.resize(at + kEntryHead + entry.data.size());
    write_entry(entry, log.data() + at);
  }
  void contradiction(const Statement& a, const Statement& b) noexcept override {
    const bool proved = Proof{Key{}, a, b}.convicts(s_.signing_open_[a.sender]);
    if (proved && a.sender == s_.faults_.liar)
      ++s_.totals_.convictions;
    else
      s_.wrong(s_.totals_.statements_wrong, "an honest node is convicted", id_, agent_->sample());
  }
  void ended(const Sample& sample) noexcept override {
    fresh_ = true;
    s_.check_sample(id_, sample);
  }
  void keep_snapshot() {
    if (!fresh_ || node_->core().state() != Core::State::waiting || agent_->sample() % 10 != 0) return;
    fresh_ = false;
    Octets made(agent_->snapshot_bytes());
    if (node_->core().snapshot(made) != 0) disk_ = made;
  }
  /// Another lie to everybody: huge numbers, infinities, short bodies, bytes at random, wrong rounds.
  std::size_t operator()(int neighbour, Room plain, std::size_t size) noexcept override {
    Seeded& random = s_.random_;
    if (Inner::read(plain.data()).kind == Kind::statement) return sign_another(neighbour, plain, size);
    if (size < kInner + 16) return size;  // not a message of two numbers
    switch (random.below(10)) {
      case 0:
        wire::store(plain.data() + kInner + 8, std::uint64_t{0x7ff0000000000000U});
        return size;
      case 1:
        return kInner + random.below(size - kInner);
      case 2:
        plain[kInner + random.below(size - kInner)] = static_cast<std::byte>(random.next());
        return size;
      case 3:
        plain[2] = static_cast<std::byte>(random.next());
        return size;
      case 4:
        wire::store(plain.data() + 4, random.next());
        return size;
      default:
        wire::store_double(plain.data() + kInner,
                           signed_unit(random) * std::pow(10.0, static_cast<double>(random.below(100))));
        return size;
    }
  }

  /// The statements of its own that a liar shows to half of its neighbours are about other bodies.
  std::size_t sign_another(int neighbour, Room plain, std::size_t size) noexcept {
    auto said = Statement::read(Bytes(plain).subspan(kInner, Statement::kSize));
    if (!said || said->sender != id_ || neighbour % 2 == 0) return size;
    said->digest[0] ^= std::byte{1};
    garrison::node::sign(*said, Key{}, s_.signing_[static_cast<std::size_t>(id_)]);
    said->write(plain.data() + kInner);
    return size;
  }

  Simulation& s_;
  int id_;
  std::uint64_t boots_ = 0;
  std::unique_ptr<Agent> agent_;
  std::unique_ptr<Authors> authors_;
  std::unique_ptr<Node> node_;
  Octets disk_;
  std::vector<Octets> logs_;  ///< one per boot
  bool fresh_ = false;
  bool missed_ = false;
};

Simulation::Simulation(std::uint64_t seed, Totals& totals, bool verbose)
    : seed_(seed),
      totals_(totals),
      verbose_(verbose),
      random_(seed * 77777 + 5),
      prepared_(shared_design(kAgents)),
      schedule_{.start = 1'000'000},
      faults_(kAgents, random_) {
  prologue_.fill(std::byte{7});
  Seeded for_keys(1);
  for (int i = 0; i < kAgents; ++i) keys_.push_back(key_pair(for_keys.key()));
  if (seed % 5 == 1)
    for (int i = 0; i < kAgents; ++i) {
      signing_open_.emplace_back();
      signing_.push_back(signing_key(for_keys.key(), signing_open_.back()));
    }
  make_plant();
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

void Simulation::make_plant() {
  const Model& model = prepared_->model();
  x0_ = Vector{{1.0, 0.0}};
  Vector x = x0_ + 0.99 * random_.uniform() * direction(2 * std::numbers::pi * random_.uniform());
  for (int t = 0; t <= kSamples + 2; ++t) {
    states_.push_back(x);
    std::vector<double> y;
    for (int i = 0; i < kAgents; ++i) y.push_back((model.C(i) * x)(0) + 0.01 * signed_unit(random_));
    if (faults_.attacked && t > 20) {
      const double lies[] = {0.3, 50.0 * signed_unit(random_), 0.02 * t};
      y[static_cast<std::size_t>(*faults_.attacked)] += lies[seed_ % 3];
    }
    measurements_.push_back(y);
    x = model.A() * x + 0.002 * random_.uniform() * direction(2 * std::numbers::pi * random_.uniform());
  }
}

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

void Simulation::check_sample(int node, const Sample& sample) {
  Agent& agent = stations_[static_cast<std::size_t>(node)]->agent();
  Vector x(2);
  agent.estimate({x.data(), 2});
  ++totals_.estimates;
  if (!x.allFinite()) wrong(totals_.estimates_wrong, "an estimate is not finite", node, sample.sample);
  if (faults_.liar >= 0) return;  // bounds and proofs are of sensors that lie, not of senders
  if (std::isfinite(sample.report.bound) && sample.sample < static_cast<std::int64_t>(states_.size())) {
    ++totals_.bounds;
    const double error = (x - states_[static_cast<std::size_t>(sample.sample)]).norm();
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
    agents.back()->reset(x0_);
  }
  std::vector<Octets> bodies(kAgents, Octets(agents[0]->most_bytes()));
  for (std::int64_t t = 1; t < kSamples - 1; ++t) {
    const auto& y = measurements_[static_cast<std::size_t>(t)];
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

void Simulation::wrong(std::int64_t& counter, const char* what, int node, std::int64_t sample) {
  ++counter;
  if (verbose_)
    std::printf("  seed %llu, node %d, sample %lld: %s\n", static_cast<unsigned long long>(seed_), node,
                static_cast<long long>(sample), what);
}

}  // namespace garrison::node::test
