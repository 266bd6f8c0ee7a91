// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/desk.hpp"

#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cstdio>

#include "garrison/engine/design_file.hpp"
#include "node/daemon/memory.hpp"
#include "node/daemon/service.hpp"
#include "node/daemon/state.hpp"

namespace garrison::node {

namespace {
constexpr int kPauseMs = 20;
constexpr Micros kFlushPause = 1'000'000;
constexpr Micros kSettling = 3'000'000;
constexpr int kIdleMs = 200;  // until there is a loop to be there for

Descriptor signals_to_read() {
  const sigset_t watched = node_signals();
  return Descriptor(::signalfd(-1, &watched, SFD_NONBLOCK | SFD_CLOEXEC));
}
}  // namespace

Desk::Desk(Station& station, std::uint64_t boot, std::unique_ptr<Sensor> sensor, Ring& ring, bool print)
    : station_(station),
      sensor_(std::move(sensor)),
      ring_(ring),
      print_(print),
      mirror_(read_part(station.part)) {
  const Settings& s = station.settings;
  if (s.log_inputs) log_.emplace(s.log_folder, station.self.name, boot, station.part, s.log_files);
  around_.node = station.self.name;
  around_.id = station.self.id;
  around_.family = std::string(station.agent->family());
  around_.boot = boot;
  for (const Member& m : station.links) around_.names.push_back(m.name);
  if (!s.socket.empty())
    socket_ =
        std::make_unique<LocalSocket>(s.socket, [this](std::string_view request) { return answer(request); });
}

void Desk::run(Loop& loop) {
  loop_ = &loop;
  const Descriptor signals = signals_to_read();
  saved_at_ = now().steady;
  settles_at_ = saved_at_ + kSettling;
  while (!ended(signals.get()) && !loop.over()) {
    wait(signals.get(), kPauseMs);
    tick(now().steady);
  }
  if (loop.over())
    say(Priority::notice, "the known inputs end with sample " + std::to_string(station_.inputs.last()) +
                              ", and the node with them ([input].path)");
  loop.end();
}

bool Desk::wait_until(const std::function<bool()>& ready) {
  const Descriptor signals = signals_to_read();
  while (!ready()) {
    if (ended(signals.get())) return false;
    wait(signals.get(), kIdleMs);
    if (socket_) socket_->serve();
    notify("WATCHDOG=1");
  }
  return true;
}

/// Whether a signal ended the node. A hang-up means the files are new, as with other services; to a node that
/// was started by hand it means that its terminal is gone.
bool Desk::ended(int signals) {
  signalfd_siginfo came{};
  if (::read(signals, &came, sizeof came) != sizeof came) return false;
  if (came.ssi_signo != SIGHUP || by_hand_) return true;
  const std::string answer = reload();
  const bool taken = answer == kOk;
  say(taken ? Priority::notice : Priority::error,
      "SIGHUP: files " + (taken ? "read anew" : "not read: " + answer));
  return false;
}

void Desk::wait(int signals, int milliseconds) {
  std::vector<pollfd> all{{signals, POLLIN, 0}};
  if (sensor_->descriptor() >= 0) all.push_back({sensor_->descriptor(), POLLIN, 0});
  if (socket_) socket_->wait_for(all);
  ::poll(all.data(), all.size(), milliseconds);
}

void Desk::tick(Micros steady) {
  if (former_ && loop_->turns() > former_until_) former_.reset();
  sensor_->tick(steady);
  if (sensor_->descriptor() >= 0) sensor_->readable(now().wall);
  drain();
  if (socket_) socket_->serve();
  if (log_ && !log_lost_ && log_->file().bytes() >= station_.settings.log_bytes) loop_->ask_fresh();
  if (steady - flushed_at_ >= kFlushPause) {
    flushed_at_ = steady;
    flush_log();
  }
  if (steady - saved_at_ >= station_.settings.state_every) save_state();
  watch_over(steady);
  if (settles_at_ == 0 || steady < settles_at_) return;
  settles_at_ = 0;
  settle_memory();
}

void Desk::drain() {
  while (ring_.take(room_,
                    [this](std::uint8_t note, Bytes content) { record(static_cast<Note>(note), content); })) {
  }
}

void Desk::record(Note note, Bytes content) {
  switch (note) {
    case Note::call:
      if (log_)
        log_->file().entry(content.subspan(8),
                           static_cast<Micros>(wire::load<std::uint64_t>(content.data())));
      return;
    case Note::status:
      return status(content);
    case Note::snapshot:
      return snapshot(content);
    case Note::proof:
      return proof(content);
    case Note::fresh:
      return begin_log();
  }
}

void Desk::status(Bytes content) {
  known_ = status_.read(content, static_cast<std::size_t>(station_.agent->states()), station_.links.size());
  if (!known_ || !status_.head.ended) return;
  const auto led = station_.inputs.before(status_.head.sample.sample);
  around_.input.assign(led.begin(), led.end());
  const bool wanted = log_ || print_ || (socket_ && socket_->watched());
  if (!wanted) return;
  const std::string line = sample_json(status_, around_);
  if (log_) log_->file().sample(line, status_.head.wall);
  if (print_) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
  if (socket_) socket_->tell(line);
}

void Desk::snapshot(Bytes content) {
  snapshot_.assign(content.begin(), content.end());
  snapshot_at_ = now().steady;
  if (mirror_->load(content) != Refusal::none) return;
  around_.accused = mirror_->accused();
  around_.proved = mirror_->proved();
}

/// A disk that takes no more logs does not end the node.
void Desk::begin_log() {
  if (!log_) return;
  try {
    log_->begin();
    log_lost_ = false;
  } catch (const std::exception& error) {
    lose_log(error.what());
  }
}
void Desk::lose_log(const std::string& why) {
  if (!std::exchange(log_said_, true))
    say(Priority::error, "no log from here on, until there is room: " + why);
  log_lost_ = true;
}

/// Once a second: to the disk; where that has failed, anew as soon as it has room.
void Desk::flush_log() {
  if (!log_) return;
  log_->file().flush();
  around_.log_failed = log_->failed();
  if (!log_->whole())
    lose_log(log_->folder() + ": got a disk that does not take it");
  else if (!log_lost_)
    log_said_ = false;
  if (log_lost_ && log_->room()) loop_->ask_fresh();
}

/// The one thing that is worth a line in the journal, and a file for others to check.
void Desk::proof(Bytes content) {
  const auto found = Proof::read(content);
  if (!found) return;
  const Member* who = station_.roster.find(int{found->a.sender});
  const std::string folder = beside(station_.settings.state_folder, "proofs");
  const std::string path =
      beside(folder, std::to_string(found->a.sender) + "-" + std::to_string(found->a.boot) + "-" +
                         std::to_string(found->a.first) + ".proof");
  try {
    make_folder(folder);
    replace_file(path, content);
    say(Priority::warning, (who == nullptr ? "somebody" : who->name) +
                               " has signed two different statements about sample " +
                               std::to_string(found->a.first) + ": " + path);
  } catch (const Error& error) {
    if (!std::exchange(failing_, true)) say(Priority::error, error.what());
  }
}

void Desk::save_state() {
  saved_at_ = now().steady;
  if (snapshot_.empty()) return;
  try {
    write_state(station_.settings.state_folder, station_.run, snapshot_);
    stored_at_ = snapshot_at_;
    failing_ = false;
  } catch (const Error& error) {
    if (!std::exchange(failing_, true)) say(Priority::error, error.what());
  }
}

/// The manager hears of us only while the loop turns.
void Desk::watch_over(Micros steady) {
  static const Micros pause = watchdog_pause();
  if (pause == 0 || steady - watched_at_ < pause / 2 || loop_->turns() == turns_seen_) return;
  watched_at_ = steady;
  turns_seen_ = loop_->turns();
  notify("WATCHDOG=1\nSTATUS=" + std::string(word(status_.head.state)) + ", sample " +
         std::to_string(status_.head.sample.sample));
}

}  // namespace garrison::node
