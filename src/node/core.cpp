// SPDX-License-Identifier: Apache-2.0
#include "garrison/node/core.hpp"

#include <cstdlib>
#include <limits>

namespace garrison::node {

Core::Core(Agent& agent, const Schedule& schedule, Outlet& outlet)
    : agent_(agent),
      schedule_(schedule),
      outlet_(outlet),
      rounds_(static_cast<std::size_t>(agent.rounds())),
      neighbours_(agent.neighbours().begin(), agent.neighbours().end()),
      places_(2 * rounds_ * neighbours_.size()),
      silent_(neighbours_.size(), 0),
      history_(2 * rounds_ * agent.most_bytes()),
      sizes_(2 * rounds_, 0),
      history_of_(2 * rounds_, INT64_MIN),
      numbers_(static_cast<std::size_t>(std::max(agent.outputs(), agent.states()))),
      bytes_(std::max(8 * numbers_.size(), agent.most_bytes())) {}

void Core::start(const Vector& x0, Instant now) {
  watch_clock(now);
  agent_.reset(x0);
  note_numbers(Call::reset, agent_.start(), {x0.data(), static_cast<std::size_t>(x0.size())});
  state_ = State::waiting;
}

bool Core::restore(Bytes snapshot, Instant now) {
  watch_clock(now);
  if (agent_.load(snapshot) != Refusal::none) return false;
  note(Call::load, agent_.sample(), 0, snapshot);
  const std::int64_t slot = schedule_.slot(now.wall);
  // Whatever an earlier life sent in this slot is not sent again.
  sent_ = std::max(slot, agent_.sample());
  if (slot < agent_.sample())
    state_ = State::held;
  else if (slot - agent_.sample() > schedule_.catch_up)
    listen(now);
  else
    state_ = State::waiting;
  return true;
}

void Core::listen(Instant now) {
  watch_clock(now);
  start_listening(schedule_.listen_for);
}

void Core::tick(Instant now) noexcept {
  if (state_ == State::idle) return;
  watch_clock(now);
  in_contact_ = now.steady - contact_at_ <= kContact;
  const std::int64_t slot = schedule_.slot(now.wall);
  if (state_ == State::listening) hear(slot);
  if (state_ == State::rounds && slot > agent_.sample()) {
    ++counters_.overruns;
    finish_rounds(now);
  }
  if (state_ == State::held && slot > sent_) leave_hold(slot);
  const bool next = slot > std::max(sent_, agent_.sample());
  if (state_ == State::waiting && next) begin_sample(slot, now);
  if (state_ == State::rounds) advance(now);
}

Fate Core::message(int neighbour, std::int64_t sample, int round, Bytes body, std::uint64_t mark,
                   Instant now) noexcept {
  if (state_ == State::idle || state_ == State::held) return Fate::off;
  const std::size_t k = neighbour_of(neighbour);
  if (k == neighbours_.size()) return Fate::stranger;
  if (round < 0 || round >= agent_.rounds()) return Fate::early;
  Place& at = places_[place(sample, round, k)];
  if (at.sample == sample) return at.mark == mark ? Fate::duplicate : Fate::conflict;
  const Fate fate = fate_of(agent_.deliver({neighbour, sample, round}, body));
  // Alive after all: it is waited for again, or an absent neighbour would stay absent for ever.
  if (fate == Fate::taken || (fate == Fate::late && sample == agent_.sample())) silent_[k] = 0;
  if (fate != Fate::taken) {
    others_ |= fate == Fate::late || fate == Fate::early;
    return fate;
  }
  at = {sample, mark};
  note(Call::deliver, sample, round, body, neighbour);
  if (state_ == State::rounds) advance(now);
  return fate;
}

void Core::contact(int neighbour, Instant now) noexcept {
  if (neighbour_of(neighbour) < neighbours_.size()) contact_at_ = now.steady;
}

Fate Core::wanted(int neighbour, std::int64_t sample, int round) noexcept {
  if (round < 0 || round >= agent_.rounds()) return Fate::early;
  const std::size_t at = kept(sample, round);
  if (history_of_[at] != sample || sizes_[at] == 0) return Fate::off;
  ++counters_.resent;
  outlet_.answer(neighbour, sample, round, {history_.data() + at * agent_.most_bytes(), sizes_[at]});
  return Fate::taken;
}

Micros Core::due() const noexcept {
  const std::int64_t t = agent_.sample();
  switch (state_) {
    case State::idle:
      return std::numeric_limits<Micros>::max();
    case State::listening:
      return heard_slot_ == INT64_MIN ? schedule_.begin(agent_.start() + 1)
                                      : schedule_.begin(heard_slot_ + 1);
    case State::waiting:
      return schedule_.begin(std::max(sent_, t) + 1);
    case State::held:
      return schedule_.begin(sent_ + 1);
    case State::rounds:
      break;
  }
  Micros next = std::min(schedule_.begin(t) + (agent_.round() + 1) * schedule_.round, schedule_.begin(t + 1));
  if (want_at_ != 0 && wants_ < schedule_.wants) next = std::min(next, want_at_ + offset_);
  return next;
}

bool Core::absent(int neighbour) const noexcept {
  const std::size_t k = neighbour_of(neighbour);
  return k < neighbours_.size() && silent_[k] >= schedule_.absent_after;
}

std::size_t Core::snapshot(Room out) const noexcept {
  if (state_ != State::waiting || agent_.sample() <= agent_.start()) return 0;
  return agent_.save(out);
}

std::size_t Core::neighbour_of(int id) const noexcept {
  const auto at = std::lower_bound(neighbours_.begin(), neighbours_.end(), id);
  return at != neighbours_.end() && *at == id ? static_cast<std::size_t>(at - neighbours_.begin())
                                              : neighbours_.size();
}
std::size_t Core::kept(std::int64_t sample, int round) const noexcept {
  return static_cast<std::size_t>(static_cast<std::uint64_t>(sample) & 1U) * rounds_ +
         static_cast<std::size_t>(round);
}
std::size_t Core::place(std::int64_t sample, int round, std::size_t neighbour) const noexcept {
  return kept(sample, round) * neighbours_.size() + neighbour;
}

/// A jump of wall time against steady time. Forward: slots that nobody else has reached yet must not be
/// filled, so the network is listened to first. Back: nothing is sent twice, so it is waited for what was
/// sent.
void Core::watch_clock(Instant now) noexcept {
  const Micros offset = now.wall - now.steady;
  const Micros step = clock_known_ ? offset - offset_ : 0;
  offset_ = offset;
  clock_known_ = true;
  if (state_ == State::idle || std::abs(step) <= schedule_.period / 2) return;
  ++counters_.clock_steps;
  if (state_ == State::rounds) finish_rounds(now);
  const std::int64_t slot = schedule_.slot(now.wall);
  if (slot <= sent_) {
    ++counters_.clock_back;
    state_ = State::held;
  } else if (agent_.sample() > agent_.start() || state_ == State::listening) {
    start_listening(schedule_.listen_after_step);
  }
}

/// Where it was listening, or is ahead with nothing sent, it has to hear the others first.
void Core::leave_hold(std::int64_t slot) noexcept {
  if (agent_.round() < agent_.rounds() || slot <= agent_.sample()) {
    start_listening(schedule_.listen_after_step);
    hear(slot);
  } else {
    state_ = State::waiting;
  }
}

void Core::start_listening(int slots) noexcept {
  state_ = State::listening;
  listen_for_ = slots;
  heard_slot_ = INT64_MIN;
  alone_ = 0;
}

void Core::hear(std::int64_t slot) noexcept {
  if (slot <= agent_.start() || slot <= sent_ || slot == heard_slot_) return;
  if (heard_slot_ != INT64_MIN && slot > heard_slot_) {
    bool heard = false;
    for (std::size_t k = 0; k < neighbours_.size(); ++k)
      heard |= places_[place(heard_slot_, 0, k)].sample == heard_slot_;
    alone_ = heard || others_ ? 0 : alone_ + 1;
    if (heard || alone_ >= listen_for_) {
      // Neighbours that are there and say nothing wait for somebody to begin, as we do.
      const bool speak = !heard && in_contact_;
      agent_.join(speak);
      note(Call::join, heard_slot_, speak ? 1 : 0);
      ++counters_.joins;
      state_ = State::waiting;
      return;
    }
  }
  if (slot <= agent_.sample()) {  // the clock went back while nothing was sent
    const auto n = static_cast<std::size_t>(agent_.states());
    agent_.estimate({numbers_.data(), n});
    const Vector x = Eigen::Map<const Vector>(numbers_.data(), agent_.states());
    agent_.reset(x, slot - 1);
    note_numbers(Call::reset, slot - 1, {numbers_.data(), n});
  }
  agent_.listen(slot);
  note(Call::listen, slot);
  heard_slot_ = slot;
  others_ = false;
}

void Core::finish_rounds(Instant now) noexcept {
  while (state_ == State::rounds) fuse(now, false);
}

void Core::begin_sample(std::int64_t slot, Instant now) noexcept {
  const std::int64_t missed = slot - agent_.sample() - 1;
  if (missed > Agent::kMostGap) return listen(now);
  counters_.missed_samples += missed;
  const std::span<double> y(numbers_.data(), static_cast<std::size_t>(agent_.outputs()));
  std::fill(y.begin(), y.end(), kNaN);
  outlet_.measure(slot, y);
  measured_ = std::any_of(y.begin(), y.end(), [](double v) { return v == v; });
  counters_.unmeasured += measured_ ? 0 : 1;
  note_numbers(Call::sense, slot, y);
  sent_ = slot;
  complete_ = missed == 0;
  state_ = State::rounds;
  const Agent::Sent first = agent_.sense(slot, y, bytes_);
  if (first.refusal != Refusal::none) return start_listening(schedule_.listen_for);  // no round to be in
  silent_sample_ = first.bytes == 0;
  post(first, 0, true);
}

void Core::advance(Instant now) noexcept {
  while (state_ == State::rounds) {
    const Micros over = schedule_.begin(agent_.sample()) + (agent_.round() + 1) * schedule_.round;
    if (!complete_round() && now.wall < over) return ask(now);
    fuse(now, true);
  }
}

bool Core::complete_round() const noexcept {
  for (std::size_t k = 0; k < neighbours_.size(); ++k)
    if (silent_[k] < schedule_.absent_after && !agent_.has(neighbours_[k])) return false;
  return true;
}

void Core::ask(Instant now) noexcept {
  if (want_at_ == 0) want_at_ = now.steady + schedule_.resend;
  if (now.steady < want_at_ || wants_ >= schedule_.wants) return;
  want_at_ = now.steady + schedule_.resend;
  ++wants_;
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    if (silent_[k] >= schedule_.absent_after || agent_.has(neighbours_[k])) continue;
    ++counters_.wants;
    outlet_.want(neighbours_[k], agent_.sample(), agent_.round());
  }
}

void Core::fuse(Instant now, bool send) noexcept {
  const int round = agent_.round();
  for (std::size_t k = 0; k < neighbours_.size(); ++k) {
    if (agent_.has(neighbours_[k])) {
      silent_[k] = 0;
      silent_sample_ = false;
      continue;
    }
    ++counters_.missing;
    complete_ = false;
    if (round == 0) ++silent_[k];
  }
  note(Call::fuse, agent_.sample(), round);
  const Agent::Sent sent = agent_.fuse(bytes_);
  if (agent_.round() < agent_.rounds())
    post(sent, round + 1, send);
  else
    end_sample(now);
}

void Core::post(Agent::Sent sent, int round, bool send) noexcept {
  const std::size_t at = kept(agent_.sample(), round);
  history_of_[at] = agent_.sample();
  sizes_[at] = send ? sent.bytes : 0;  // what was not sent in time, and not signed, is not sent later
  wants_ = 0;
  want_at_ = 0;
  if (sent.bytes == 0 || !send) return;
  const Bytes body(bytes_.data(), sent.bytes);
  copy(body, history_.data() + at * agent_.most_bytes());
  outlet_.broadcast(agent_.sample(), round, body);
}

void Core::end_sample(Instant now) noexcept {
  state_ = State::waiting;
  ++counters_.samples;
  counters_.complete += complete_ ? 1 : 0;
  const std::span<double> x(numbers_.data(), static_cast<std::size_t>(agent_.states()));
  agent_.estimate(x);
  note_numbers(Call::estimate, agent_.sample(), x);
  outlet_.ended(
      {agent_.sample(), agent_.report(), complete_, measured_, now.wall - schedule_.begin(agent_.sample())});
  // Neither we nor anybody around said a word: listen, and begin if it stays so.
  if (silent_sample_ && rounds_ > 0 && in_contact_) start_listening(schedule_.listen_for);
}

void Core::note(Call call, std::int64_t sample, int round, Bytes data, int sender) noexcept {
  outlet_.journal({call, sender, round, sample, data});
}
void Core::note_numbers(Call call, std::int64_t sample, std::span<const double> numbers) noexcept {
  write_numbers(numbers, bytes_.data());
  note(call, sample, 0, {bytes_.data(), 8 * numbers.size()});
}

}  // namespace garrison::node
