// SPDX-License-Identifier: Apache-2.0
// One agent's samples and rounds against the clock, as a state machine without input or output: it is told
// the time and what neighbours sent, and says what to send. docs/node.md has its table of states.
#pragma once

#include <string_view>
#include <vector>

#include "garrison/engine/agent.hpp"
#include "garrison/node/fate.hpp"
#include "garrison/node/journal.hpp"

namespace garrison::node {

/// The same on all nodes but for what only concerns one. Times in microseconds.
struct Schedule {
  Micros start = 0;  ///< begin of sample 0, wall
  Micros period = 100'000;
  Micros round = 25'000;  ///< round r is over at (r + 1) * round after the begin of its sample
  Micros resend =
      6'000;             ///< how long a missing message is waited for before it is asked for, again and again
  int wants = 16;        ///< at most so often per message
  int absent_after = 3;  ///< samples without a word before a neighbour is no longer waited for
  int listen_for = 5;    ///< samples to wait for somebody before going on alone, at a start
  int listen_after_step = 50;               ///< the same after a jump of the clock, which may be wrong
  std::int64_t catch_up = Agent::kMostGap;  ///< samples a snapshot may be old

  std::int64_t slot(Micros wall) const noexcept {
    const Micros since = wall - start;
    return since >= 0 ? since / period : -((-since + period - 1) / period);
  }
  Micros begin(std::int64_t sample) const noexcept { return start + sample * period; }
};

/// The end of a sample.
struct Sample {
  std::int64_t sample = 0;
  Report report;
  bool complete = false;  ///< every neighbour's message of every round was there
  bool measured = false;
  Micros took = 0;  ///< from the begin of the sample to here, wall
};

/// What the state machine asks of its surroundings. Nothing here may call it back.
/// Threads: one at a time.
class Outlet {
 public:
  virtual ~Outlet() = default;
  /// Sample `sample` begins: its measurement into y (NaN where there is none).
  virtual void measure(std::int64_t sample, std::span<double> y) noexcept = 0;
  virtual void broadcast(std::int64_t sample, int round, Bytes body) noexcept = 0;
  virtual void answer(int neighbour, std::int64_t sample, int round, Bytes body) noexcept = 0;
  virtual void want(int neighbour, std::int64_t sample, int round) noexcept = 0;
  virtual void journal(const Entry& entry) noexcept = 0;
  virtual void ended(const Sample& sample) noexcept = 0;
};

/// Threads: one at a time.
class Core {
 public:
  enum class State : std::uint8_t {
    idle,       ///< not told how to begin
    listening,  ///< hears the network that it will join, says nothing
    waiting,    ///< between samples
    rounds,     ///< in the rounds of a sample
    held,       ///< the clock went back behind samples that were sent: waits for it
  };
  struct Counters {
    std::int64_t samples = 0;
    std::int64_t complete = 0;
    std::int64_t unmeasured = 0;
    std::int64_t missing = 0;         ///< messages
    std::int64_t missed_samples = 0;  ///< slots that went by without us
    std::int64_t overruns = 0;        ///< samples that the next one's begin ended
    std::int64_t wants = 0;
    std::int64_t resent = 0;
    std::int64_t joins = 0;
    std::int64_t clock_steps = 0;
    std::int64_t clock_back = 0;
  };

  /// Keeps references to all three.
  Core(Agent& agent, const Schedule& schedule, Outlet& outlet);

  /// A start that bounds cover: with the network, before its first sample. Else `listen`.
  void start(const Vector& x0, Instant now);
  /// From a snapshot; false when it is not ours, or so old that listening is better (as is then done).
  bool restore(Bytes snapshot, Instant now);
  void listen(Instant now);

  void tick(Instant now) noexcept;
  /// A genuine message of a neighbour. `mark`: a digest of the body, by which a second one is told from a
  /// copy.
  Fate message(int neighbour, std::int64_t sample, int round, Bytes body, std::uint64_t mark,
               Instant now) noexcept;
  Fate wanted(int neighbour, std::int64_t sample, int round) noexcept;
  /// Anything genuine came from a neighbour.
  void contact(int neighbour, Instant now) noexcept;
  /// When `tick` has to be called next, wall time.
  Micros due() const noexcept;

  State state() const noexcept { return state_; }
  const Counters& counters() const noexcept { return counters_; }
  bool absent(int neighbour) const noexcept;
  /// Bytes of a snapshot into out; 0 while a sample is under way.
  std::size_t snapshot(Room out) const noexcept;

 private:
  struct Place {
    std::int64_t sample = INT64_MIN;
    std::uint64_t mark = 0;
  };
  std::size_t neighbour_of(int id) const noexcept;
  std::size_t place(std::int64_t sample, int round, std::size_t neighbour) const noexcept;
  std::size_t kept(std::int64_t sample, int round) const noexcept;

  void watch_clock(Instant now) noexcept;
  void leave_hold(std::int64_t slot) noexcept;
  void start_listening(int slots) noexcept;
  void hear(std::int64_t slot) noexcept;
  void finish_rounds(Instant now) noexcept;
  void begin_sample(std::int64_t slot, Instant now) noexcept;
  void advance(Instant now) noexcept;
  bool complete_round() const noexcept;
  void ask(Instant now) noexcept;
  void fuse(Instant now, bool send) noexcept;
  void post(Agent::Sent sent, int round, bool send) noexcept;
  void end_sample(Instant now) noexcept;
  void note(Call call, std::int64_t sample, int round = 0, Bytes data = {}, int sender = 0) noexcept;
  void note_numbers(Call call, std::int64_t sample, std::span<const double> numbers) noexcept;

  Agent& agent_;
  Schedule schedule_;
  Outlet& outlet_;
  State state_ = State::idle;
  std::size_t rounds_;
  std::vector<int> neighbours_;

  std::vector<Place> places_;       ///< what was delivered: two samples, all rounds, all neighbours
  std::vector<int> silent_;         ///< samples in a row without a first message, per neighbour
  std::vector<std::byte> history_;  ///< our bodies of two samples, for those who ask again
  std::vector<std::size_t> sizes_;
  std::vector<std::int64_t> history_of_;
  std::vector<double> numbers_;
  std::vector<std::byte> bytes_;

  std::int64_t sent_ = INT64_MIN;  ///< the last sample that anything may have been sent of
  std::int64_t heard_slot_ = 0;    ///< listening: the slot that is listened to
  int alone_ = 0;                  ///< slots that nobody was heard in
  int listen_for_ = 0;
  bool others_ = false;                          ///< somebody was heard, but at another time
  static constexpr Micros kContact = 1'500'000;  ///< signs of life come more often
  Micros contact_at_ = INT64_MIN / 2;            ///< steady
  bool in_contact_ = false;
  bool silent_sample_ = false;  ///< nothing was sent in this sample, nor heard
  bool complete_ = true;
  bool measured_ = false;
  int wants_ = 0;
  Micros want_at_ = 0;
  Micros offset_ = 0;  ///< wall - steady
  bool clock_known_ = false;
  Counters counters_;
};

constexpr std::string_view word(Core::State state) {
  constexpr std::string_view words[] = {"idle", "listening", "waiting", "rounds", "held"};
  return words[static_cast<std::size_t>(state)];
}

}  // namespace garrison::node
