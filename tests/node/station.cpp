// SPDX-License-Identifier: Apache-2.0
#include "station.hpp"

#include <cmath>

#include "equivocation.hpp"

namespace garrison::node::test {

void Simulation::Station::boot() {
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
    node_->core().start(s_.plant_.x0, clock());
  else if (disk_.empty() || !node_->core().restore(disk_, clock()))
    node_->core().listen(clock());
}

void Simulation::Station::crash(bool lost) {
  count();
  node_.reset();
  if (lost) disk_.clear();
}

void Simulation::Station::sign() {
  authors_ =
      std::make_unique<Authors>(Authors::Setup{id_,
                                               s_.signing_[static_cast<std::size_t>(id_)],
                                               boots_,
                                               Key{},
                                               s_.signing_open_,
                                               {agent_->neighbours().begin(), agent_->neighbours().end()},
                                               agent_->rounds(),
                                               kBatch});
  node_->sign_with(*authors_);
}

void Simulation::Station::tick() {
  node_->tick(clock());
  keep_snapshot();
}

Fate Simulation::Station::receive(Bytes bytes) {
  const Fate fate = node_->receive(bytes, clock());
  keep_snapshot();
  return fate;
}

void Simulation::Station::count() {
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

Instant Simulation::Station::clock() const {
  return {s_.now_ + s_.faults_.skew[static_cast<std::size_t>(id_)] + step, s_.now_ + 7'000'000};
}

void Simulation::Station::measure(std::int64_t sample, std::span<double> y) noexcept {
  const auto& all = s_.plant_.measurements;
  if (sample >= 0 && sample < static_cast<std::int64_t>(all.size()))
    y[0] = all[static_cast<std::size_t>(sample)][static_cast<std::size_t>(id_)];
}

void Simulation::Station::journal(const Entry& entry) noexcept {
  Octets& log = logs_.back();
  const std::size_t at = log.size();
  log.resize(at + kEntryHead + entry.data.size());
  write_entry(entry, log.data() + at);
}

void Simulation::Station::contradiction(const Statement& a, const Statement& b) noexcept {
  const bool proved = Proof{Key{}, a, b}.convicts(s_.signing_open_[a.sender]);
  if (proved && a.sender == s_.faults_.liar)
    s_.convicted(id_);
  else
    s_.wrong(s_.totals_.statements_wrong, "an honest node is convicted", id_, agent_->sample());
}

void Simulation::Station::ended(const Sample& sample) noexcept {
  fresh_ = true;
  s_.check_sample(id_, sample);
}

void Simulation::Station::keep_snapshot() {
  if (!fresh_ || node_->core().state() != Core::State::waiting || agent_->sample() % 10 != 0) return;
  fresh_ = false;
  Octets made(agent_->snapshot_bytes());
  if (node_->core().snapshot(made) != 0) disk_ = made;
}

/// Another lie to everybody: huge numbers, infinities, short bodies, bytes at random, wrong rounds.
std::size_t Simulation::Station::operator()(int neighbour, Room plain, std::size_t size) noexcept {
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
                         random.signed_unit() * std::pow(10.0, static_cast<double>(random.below(100))));
      return size;
  }
}

/// The statements of its own that a liar shows to half of its neighbours are about other bodies.
std::size_t Simulation::Station::sign_another(int neighbour, Room plain, std::size_t size) noexcept {
  if (neighbour % 2 == 0) return size;
  const SigningKey& key = s_.signing_[static_cast<std::size_t>(id_)];
  if (state_otherwise(plain, size, id_, Key{}, key) && s_.lied_at_ < 0) s_.lied_at_ = s_.now_;
  return size;
}

}  // namespace garrison::node::test
