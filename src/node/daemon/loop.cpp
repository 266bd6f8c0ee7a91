// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/loop.hpp"

#include <poll.h>

#include <cstring>

namespace garrison::node {

namespace {
constexpr Micros kLongestWait = 20'000;       // links have timers of their own, of 250 ms and more
constexpr Micros kSnapshotPause = 1'000'000;  // between snapshots for status and disk
constexpr Micros kStatusPause = 1'000'000;    // between signs of life where no sample ends

std::vector<Neighbour> neighbours_of(const Station& station) {
  std::vector<Neighbour> out;
  for (std::size_t k = 0; k < station.links.size(); ++k) {
    Neighbour n{station.links[k].id, {}, station.listens[k]};
    exchange_key(station.links[k].open, n.key);  // the roster was refused if it has none
    out.push_back(n);
  }
  return out;
}
/// Statements are about a second, or a sample where that is longer.
Authors::Setup authors_of(const Station& station, std::uint64_t boot) {
  Authors::Setup out;
  Key open{};
  out.own = station.self.id;
  out.key = signing_key(station.identity.seed, open);
  out.boot = boot;
  hash({}, {station.run}, out.run);
  for (const Member& m : station.roster.members) {
    out.open.resize(std::max(out.open.size(), static_cast<std::size_t>(m.id) + 1));
    out.open[static_cast<std::size_t>(m.id)] = m.open;
  }
  out.neighbours.assign(station.agent->neighbours().begin(), station.agent->neighbours().end());
  out.rounds = station.agent->rounds();
  out.batch = static_cast<int>(std::clamp<Micros>(1'000'000 / station.schedule.period, 1, 64));
  return out;
}
template <class T>
Bytes bytes_of(const T& value) noexcept {
  return std::as_bytes(std::span(&value, 1));
}
}  // namespace

Loop::Loop(Station& station, std::uint64_t boot, Udp& udp, const Sensor& sensor, Ring& ring)
    : station_(station),
      udp_(udp),
      sensor_(&sensor),
      ring_(ring),
      now_(garrison::node::now()),
      authors_(authors_of(station, boot)),
      node_(*station.agent, station.schedule, station.identity.exchange, neighbours_of(station), station.run,
            boot, *this, random_),
      status_(sizeof(StatusHead) + 8 * static_cast<std::size_t>(station.agent->states()) +
              station.links.size() * sizeof(LinkStatus)),
      snapshot_(station.agent->snapshot_bytes()),
      entry_(kEntryHead +
             std::max(snapshot_.size(),
                      station.agent->most_bytes() +
                          8 * static_cast<std::size_t>(station.agent->states() + station.agent->outputs()))),
      early_(static_cast<std::size_t>(station.agent->rounds()) * station.agent->neighbours().size() *
             (kEntryHead + station.agent->most_bytes())) {}

bool Loop::begin(Bytes snapshot) {
  node_.sign_with(authors_);
  now_ = garrison::node::now();
  Core& core = node_.core();
  if (!snapshot.empty() && core.restore(snapshot, now_)) return true;
  if (station_.schedule.slot(now_.wall) <= station_.agent->start())
    core.start(station_.initial, now_);
  else
    core.listen(now_);
  return snapshot.empty();
}

void Loop::run() noexcept {
  while (!may_end()) {
    turn();
    wait();
  }
  put_snapshot();
  put_status(nullptr);
  over_.store(true);
}

void Loop::contradiction(const Statement& a, const Statement& b) noexcept {
  std::array<std::byte, Proof::kSize> bytes;
  Proof{authors_.run(), a, b}.write(bytes.data());
  ring_.put(static_cast<std::uint8_t>(Note::proof), {bytes});
}

void Loop::turn() noexcept {
  turns_.fetch_add(1, std::memory_order_relaxed);
  // A flood must not keep the clock from being looked at.
  for (int batches = 0; batches < 8; ++batches) {
    now_ = garrison::node::now();
    const int count = udp_.receive([this](Bytes datagram) { node_.receive(datagram, now_); });
    if (count < Udp::kBatch) break;
  }
  now_ = garrison::node::now();
  node_.tick(now_);
  udp_.flush();
  if (now_.steady - status_at_ >= kStatusPause) put_status(nullptr);
}

void Loop::wait() noexcept {
  const Micros due = node_.due();
  const Micros left = due == INT64_MAX ? kLongestWait : due - garrison::node::now().wall;
  const Micros pause = std::clamp<Micros>(left, 0, kLongestWait);
  pollfd socket{udp_.descriptor(), POLLIN, 0};
  const timespec time{0, static_cast<long>(1000 * pause)};
  ::ppoll(&socket, 1, &time, nullptr);
}

/// A sample that is under way is finished, or given up when the next one begins. The last that known inputs
/// lead to is there until its end: others may have lost what was said in it.
bool Loop::may_end() const noexcept {
  const std::int64_t last = station_.inputs.last();
  if (station_.agent->sample() >= last && garrison::node::now().wall >= station_.schedule.begin(last + 1))
    return true;
  if (!ending_.load(std::memory_order_relaxed)) return false;
  return node_.core().state() != Core::State::rounds || station_.agent->round() >= station_.agent->rounds() ||
         now_.wall >= station_.schedule.begin(station_.agent->sample() + 1);
}

void Loop::send(int neighbour, Bytes datagram) noexcept {
  const auto at = std::lower_bound(station_.links.begin(), station_.links.end(), neighbour,
                                   [](const Member& m, int id) { return m.id < id; });
  udp_.send(at->address, datagram);
}

void Loop::measure(std::int64_t sample, std::span<double> y) noexcept {
  sensor_.load()->measure(sample, now_.wall, y);
  station_.inputs.without(sample, y);
}

void Loop::journal(const Entry& entry) noexcept {
  if (!station_.settings.log_inputs) return;
  if (entry.call == Call::sense || entry.call == Call::listen) early_size_ = 0;
  if (entry.call == Call::deliver && entry.sample > station_.agent->sample()) keep_early(entry);
  note(entry);
}

void Loop::keep_early(const Entry& entry) noexcept {
  if (early_size_ + kEntryHead + entry.data.size() > early_.size()) return;
  early_size_ += write_entry(entry, early_.data() + early_size_);
}

void Loop::note(const Entry& entry) noexcept {
  if (broken_) return;
  const std::size_t size = write_entry(entry, entry_.data());
  broken_ = !ring_.put(static_cast<std::uint8_t>(Note::call), {bytes_of(now_.wall), {entry_.data(), size}});
  if (broken_) ++head_.log_gaps;
}

void Loop::ended(const Sample& sample) noexcept {
  const bool fresh = broken_ || fresh_wanted_.load(std::memory_order_relaxed);
  if (fresh || now_.steady - snapshot_at_ >= kSnapshotPause) put_snapshot();
  put_status(&sample);
}

/// Also where a new log begins: with the snapshot, and the messages that came before their sample.
void Loop::put_snapshot() noexcept {
  const std::size_t size = station_.agent->save(snapshot_);
  if (size == 0 || station_.agent->sample() <= station_.agent->start()) return;
  const Bytes bytes(snapshot_.data(), size);
  if (!ring_.put(static_cast<std::uint8_t>(Note::snapshot), {bytes})) return;
  snapshot_at_ = now_.steady;
  const bool fresh =
      station_.settings.log_inputs && (broken_ || fresh_wanted_.load(std::memory_order_relaxed));
  if (!fresh || !ring_.put(static_cast<std::uint8_t>(Note::fresh), {})) return;
  broken_ = false;
  fresh_wanted_.store(false, std::memory_order_relaxed);
  note({Call::load, 0, 0, station_.agent->sample(), bytes});
  Entry entry;
  std::size_t used = 0;
  for (std::size_t at = 0; at < early_size_; at += used) {
    read_entry({early_.data() + at, early_size_ - at}, entry, used);
    note(entry);
  }
}

void Loop::put_status(const Sample* sample) noexcept {
  status_at_ = now_.steady;
  head_.wall = now_.wall;
  head_.ended = sample != nullptr;
  if (sample != nullptr) head_.sample = *sample;
  head_.state = node_.core().state();
  head_.counters = node_.core().counters();
  head_.outside = node_.outside();
  head_.unsent = udp_.unsent();
  head_.statements = authors_.taken();
  head_.contradictions = authors_.contradictions();
  head_.disowned = authors_.disowned();
  head_.resets = station_.agent->resets();
  head_.control = station_.agent->control();
  std::byte* at = status_.data();
  std::memcpy(at, &head_, sizeof head_);
  at += sizeof head_;
  const auto n = static_cast<std::size_t>(station_.agent->states());
  const std::span<double> estimate(reinterpret_cast<double*>(at), n);
  station_.agent->estimate(estimate);
  station_.inputs.add(station_.agent->sample(), estimate);
  at += 8 * n;
  for (std::size_t k = 0; k < node_.links(); ++k, at += sizeof(LinkStatus)) {
    const LinkStatus link{node_.link(k, now_), node_.fates(k)};
    std::memcpy(at, &link, sizeof link);
  }
  ring_.put(static_cast<std::uint8_t>(Note::status), {status_});
}

}  // namespace garrison::node
