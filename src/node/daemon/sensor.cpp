// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/sensor.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "garrison/core/error.hpp"
#include "node/daemon/service.hpp"

namespace garrison::node {

namespace {
using Source = SensorSettings::Source;
constexpr std::size_t kLongestLine = 4096;
constexpr Micros kShortestPause = 1'000'000, kLongestPause = 60'000'000;
constexpr Micros kMachinePause = 100'000;

std::string_view trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(" \t\r\n");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r\n") - from + 1);
}

std::optional<double> number_in(std::string_view word) {
  if (word == "nan" || word == "NaN") return kNaN;
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

void require_size(const std::string& file, const char* key, const std::vector<double>& given,
                  std::size_t outputs) {
  if (!given.empty() && given.size() != outputs)
    refuse(file + ", [sensor]." + key, amount(given.size(), "number"),
           std::to_string(outputs) + ", one per output of this agent");
}

/// What would have every measurement zero or missing.
void require_sense(const std::string& file, const SensorSettings& s) {
  for (const double scale : s.scale)
    if (scale == 0.0) refuse(file + ", [sensor].scale", "0", "numbers that are not 0");
  for (std::size_t k = 0; k < std::min(s.least.size(), s.most.size()); ++k)
    if (!(s.least[k] < s.most[k]))
      refuse(file + ", [sensor].least", text(s.least[k]), "less than " + text(s.most[k]) + ", its most");
}
}  // namespace

std::optional<SensorLine> parse_line(std::string_view text, std::size_t outputs) {
  SensorLine out;
  text = trimmed(text);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \t,;"), text.size());
    std::string_view word = text.substr(0, end);
    text = trimmed(text.substr(std::min(end + 1, text.size())));
    if (word.empty()) return {};  // a separator without a number before it
    const bool stamp = word.front() == '@' && out.y.empty() && !out.taken;
    if (stamp) word.remove_prefix(1);
    const auto value = number_in(word);
    if (!value) return {};
    if (!stamp)
      out.y.push_back(*value);
    else if (std::abs(*value) < 1e11)
      out.taken = std::llround(1e6 * *value);
    else
      return {};
    if (out.y.size() > outputs) return {};
  }
  return out.y.size() == outputs ? std::optional(out) : std::nullopt;
}

Sensor::Sensor(const SensorSettings& settings, std::size_t outputs, const std::string& file)
    : settings_(settings), outputs_(outputs), reading_(outputs) {
  require_size(file, "scale", settings.scale, outputs);
  require_size(file, "offset", settings.offset, outputs);
  require_size(file, "least", settings.least, outputs);
  require_size(file, "most", settings.most, outputs);
  require_sense(file, settings);
  if (settings.source == Source::file) read_table();
  if (settings.source != Source::procfs) return;
  machine_.emplace(file + ", [sensor].read", settings.read);
  if (machine_->size() != outputs)
    refuse(file + ", [sensor].read", amount(machine_->size(), "name"),
           std::to_string(outputs) + ", one per output of this agent");
}

Sensor::~Sensor() { close(); }

void Sensor::measure(std::int64_t sample, Micros now, std::span<double> y) const noexcept {
  if (settings_.source != Source::file) return reading_.get(now, settings_.max_age, y);
  const auto rows = static_cast<std::int64_t>(outputs_ == 0 ? 0 : table_.size() / outputs_);
  if (sample < 1 || sample > rows) return std::fill(y.begin(), y.end(), kNaN);
  rows_taken_.fetch_add(1, std::memory_order_relaxed);
  const auto from = table_.begin() + (sample - 1) * static_cast<std::int64_t>(outputs_);
  std::copy(from, from + static_cast<std::int64_t>(outputs_), y.begin());
}

Sensor::Counters Sensor::counters() const noexcept {
  Counters all = counters_;
  all.taken += rows_taken_.load(std::memory_order_relaxed);
  return all;
}

/// A table is read at once: nothing of it can be late.
void Sensor::read_table() {
  const std::string text = read_text(settings_.path, "a CSV file, a row a sample ([sensor].path)");
  std::string_view rest = text;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const auto row = parse_line(rest.substr(0, end), outputs_);
    if (!row || row->taken)
      refuse(settings_.path + ", line " + std::to_string(line),
             "\"" + std::string(rest.substr(0, std::min<std::size_t>(end, 40))) + "\"",
             amount(outputs_, "number") + " (or nan), separated by commas", "a row a sample, no header");
    rest.remove_prefix(std::min(end + 1, rest.size()));
    table_.insert(table_.end(), row->y.begin(), row->y.end());
    prepare(std::span(table_).last(outputs_));
  }
}

/// Units and limits.
void Sensor::prepare(std::span<double> y) noexcept {
  for (std::size_t k = 0; k < y.size(); ++k) {
    if (!settings_.offset.empty()) y[k] -= settings_.offset[k];
    if (!settings_.scale.empty()) y[k] *= settings_.scale[k];
    const bool low = !settings_.least.empty() && y[k] < settings_.least[k];
    const bool high = !settings_.most.empty() && y[k] > settings_.most[k];
    if (!low && !high) continue;
    y[k] = kNaN;
    ++counters_.outside;
  }
}

void Sensor::line(std::string_view text, Micros now) {
  if (trimmed(text).empty()) return;
  auto found = parse_line(text, outputs_);
  if (!found) {
    ++counters_.malformed;
    return;
  }
  take(found->y, found->taken.value_or(now));
}

void Sensor::take(std::span<double> y, Micros taken) noexcept {
  prepare(y);
  reading_.put(y, taken);
  ++counters_.taken;
  failing_ = false;
}

void Sensor::read_machine(Micros steady) {
  if (steady < open_at_) return;
  open_at_ = steady + kMachinePause;
  std::vector<double> y(outputs_);
  machine_->read(steady, y);
  take(y, now().wall);
}

void Sensor::readable(Micros now) {
  std::array<char, kLongestLine> piece;
  for (int turns = 0; turns < 64; ++turns) {
    const ssize_t got = ::read(input_.get(), piece.data(), piece.size());
    if (got < 0) return;
    if (settings_.source == Source::udp) {
      line({piece.data(), static_cast<std::size_t>(got)}, now);
      continue;
    }
    if (got == 0) return ended();
    pending_.append(piece.data(), static_cast<std::size_t>(got));
    std::size_t end = 0;
    while ((end = pending_.find('\n')) != std::string::npos) {
      line(std::string_view(pending_).substr(0, end), now);
      pending_.erase(0, end + 1);
    }
    if (pending_.size() <= kLongestLine) continue;
    ++counters_.malformed;
    pending_.clear();
  }
}

void Sensor::tick(Micros steady) {
  if (machine_) return read_machine(steady);
  if (settings_.source != Source::lines && settings_.source != Source::udp) return;
  if (input_ || steady < open_at_) return;
  if (settings_.path == "-" && opened_) return;  // standard input does not come again
  if (opened_) ++counters_.restarts;
  pause_ = std::clamp(2 * pause_, kShortestPause, kLongestPause);
  open_at_ = steady + pause_;
  opened_ = true;
  open();
  if (!input_ && !std::exchange(failing_, true))
    say(Priority::error, "[sensor]: got " + std::string(std::strerror(errno)) + ", expected " + what() +
                             "; tried again now and then");
  if (input_ && settings_.command.empty()) failing_ = false;
}

/// The writer is gone; a command is started again.
void Sensor::ended() {
  if (child_ > 0 && !std::exchange(failing_, true))
    say(Priority::warning,
        "[sensor].command has ended; it is started again now and then: " + settings_.command);
  close();
}

std::string Sensor::what() const {
  if (settings_.source == Source::udp) return "[sensor].address to be free on this machine";
  return settings_.command.empty() ? settings_.path + ", a named pipe" : "a command that can be started";
}

void Sensor::open() {
  if (settings_.source == Source::udp) {
    input_ = Descriptor(
        ::socket(settings_.address.storage.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (::bind(input_.get(), settings_.address.get(), settings_.address.size) != 0) input_ = Descriptor();
  } else if (!settings_.command.empty()) {
    start_command();
  } else if (settings_.path == "-") {
    input_ = Descriptor(::dup(STDIN_FILENO));
    ::fcntl(input_.get(), F_SETFL, ::fcntl(input_.get(), F_GETFL) | O_NONBLOCK);
  } else {
    // Also for writing: a pipe whose writer goes and comes is not at its end.
    input_ = Descriptor(::open(settings_.path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  }
}

void Sensor::start_command() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;
  const Descriptor writing(ends[1]);
  input_ = Descriptor(ends[0]);
  child_ = ::fork();
  if (child_ == 0) {
    ::setpgid(0, 0);
    ::dup2(ends[1], STDOUT_FILENO);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::execl("/bin/sh", "sh", "-c", settings_.command.c_str(), nullptr);
    ::_exit(127);
  }
  ::fcntl(input_.get(), F_SETFL, O_NONBLOCK);
}

void Sensor::close() {
  input_ = Descriptor();
  pending_.clear();
  if (child_ <= 0) return;
  ::kill(-child_, SIGTERM);
  for (int waits = 0; waits < 100 && ::waitpid(child_, nullptr, WNOHANG) == 0; ++waits) ::usleep(10'000);
  ::kill(-child_, SIGKILL);  // whatever did not listen
  ::waitpid(child_, nullptr, 0);
  child_ = -1;
}

}  // namespace garrison::node
