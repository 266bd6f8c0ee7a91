// SPDX-License-Identifier: Apache-2.0
// garrison-relay: a bad network on one machine. What comes to a port of 127.0.0.1 goes on to another one, or
// is lost, late, or there twice; an attacker without keys may add datagrams of his own. Chances are drawn
// from the seed, a row of numbers for each port.
#include <arpa/inet.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <queue>
#include <string_view>

#include "garrison/core/error.hpp"
#include "node/daemon/service.hpp"
#include "node/daemon/udp.hpp"
#include "node/programs/intruder.hpp"

using namespace garrison::node;

namespace {

constexpr const char* kUsage =
    "usage: garrison-relay [--seed 1] [--loss 0] [--duplicates 0] [--delay-ms 0] [--jitter-ms 0] [--replay "
    "0]\n"
    "                      [--mutate 0] [--forge 0] [--flood 0] [--seconds 600] FROM:TO...\n"
    "\n"
    "  FROM:TO   ports of 127.0.0.1: datagrams that come to FROM go on to TO\n"
    "  --loss, --duplicates   chances per datagram, in 0..1\n"
    "  --replay, --mutate, --forge   the same of sending, too: an old datagram of anybody, a changed copy, "
    "or\n"
    "                         random bytes behind a genuine header\n"
    "  --flood                datagrams of random bytes a second, to all TO in turn\n"
    "  --seconds              after which it ends; it also ends by SIGTERM or SIGINT\n"
    "\n"
    "Prints what it did as a line of JSON. Exit codes: 0 fine, 2 refused.\n";
constexpr std::size_t kMostWaiting = 100'000;

struct Weather {
  double loss = 0, duplicates = 0, delay_ms = 0, jitter_ms = 0, seconds = 600, seed = 1;
  double replay = 0, mutate = 0, forge = 0, flood = 0;
};
struct Way {
  Descriptor from;
  Address to;
  std::mt19937_64 random;
};
struct Late {
  Micros at;
  std::size_t way;
  std::string bytes;
  bool operator<(const Late& other) const { return at > other.at; }
};
struct Counters {
  long long came = 0, lost = 0, doubled = 0, sent = 0, full = 0;
  long long replayed = 0, mutated = 0, forged = 0, flooded = 0;
};

double number_of(std::string_view option, const char* text, double most) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end == text || *end != '\0' || !(value >= 0 && value <= most))
    garrison::refuse(std::string(option), text, "a number in 0.." + garrison::text(most));
  return value;
}

Way way_of(std::string_view word, std::uint64_t seed) {
  const std::string text(word);
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) garrison::refuse("relay", text, "FROM:TO, two ports");
  const Address from = address_from(text, "127.0.0.1:" + text.substr(0, colon));
  Way way{Descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)),
          address_from(text, "127.0.0.1:" + text.substr(colon + 1)), std::mt19937_64(seed)};
  const int buffer = 4 << 20;
  ::setsockopt(way.from.get(), SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
  if (::bind(way.from.get(), from.get(), from.size) != 0)
    refuse_file(text, "a port that nobody else listens at");
  return way;
}

class Relay {
 public:
  Relay(std::vector<Way> ways, const Weather& weather) : ways_(std::move(ways)), weather_(weather) {}

  void run() {
    const sigset_t ending = ending_signals();
    ::sigprocmask(SIG_BLOCK, &ending, nullptr);
    const Descriptor signals(::signalfd(-1, &ending, SFD_NONBLOCK | SFD_CLOEXEC));
    std::vector<pollfd> all{{signals.get(), POLLIN, 0}};
    for (const Way& way : ways_) all.push_back({way.from.get(), POLLIN, 0});
    const Micros start = now().steady;
    const Micros end = start + static_cast<Micros>(1e6 * weather_.seconds);
    const Micros longest = weather_.flood > 0 ? 1000 : 100'000;
    while ((all[0].revents & POLLIN) == 0 && now().steady < end) {
      const Micros left = late_.empty() ? longest : late_.top().at - now().steady;
      const timespec pause{0, static_cast<long>(1000 * std::clamp<Micros>(left, 0, longest))};
      ::ppoll(all.data(), all.size(), &pause, nullptr);
      for (std::size_t k = 0; k < ways_.size(); ++k)
        if ((all[k + 1].revents & POLLIN) != 0) take(k);
      while (!late_.empty() && late_.top().at <= now().steady) {
        send(late_.top().way, late_.top().bytes);
        late_.pop();
      }
      flood(static_cast<double>(now().steady - start) / 1e6);
    }
    say();
  }

 private:
  bool chance(Way& way, double share) { return std::uniform_real_distribution<>(0, 1)(way.random) < share; }

  void take(std::size_t k) {
    char piece[2048];
    for (ssize_t got = 0; (got = ::recv(ways_[k].from.get(), piece, sizeof piece, 0)) >= 0;) {
      ++counters_.came;
      // Both are drawn for every datagram, so that one setting does not change what another one does.
      const bool lost = chance(ways_[k], weather_.loss);
      const bool twice = chance(ways_[k], weather_.duplicates);
      attack(k, std::string(piece, static_cast<std::size_t>(got)));
      if (lost) {
        ++counters_.lost;
        continue;
      }
      counters_.doubled += twice ? 1 : 0;
      for (int copies = twice ? 2 : 1; copies > 0; --copies)
        forward(k, std::string(piece, static_cast<std::size_t>(got)));
    }
  }

  void attack(std::size_t k, const std::string& seen) {
    Way& way = ways_[k];
    const bool replays = chance(way, weather_.replay), mutates = chance(way, weather_.mutate);
    const bool forges = chance(way, weather_.forge);
    counters_.replayed += replays && intruder_.remembers() ? 1 : 0;
    counters_.mutated += mutates ? 1 : 0;
    counters_.forged += forges ? 1 : 0;
    if (replays && intruder_.remembers()) forward(k, intruder_.old(way.random));
    if (mutates) forward(k, Intruder::mutant(way.random, seen));
    if (forges) forward(k, Intruder::forged(way.random, seen));
    if (weather_.replay > 0) intruder_.remember(way.random, seen);
  }

  /// As many as are due since the start, not more than a batch at once.
  void flood(double seconds) {
    const auto due = static_cast<long long>(weather_.flood * seconds);
    for (int batch = 0; counters_.flooded < due && batch < 1000; ++batch) {
      Way& way = ways_[static_cast<std::size_t>(counters_.flooded++) % ways_.size()];
      const std::string junk = Intruder::junk(way.random, 16 + way.random() % 80);
      ::sendto(way.from.get(), junk.data(), junk.size(), MSG_NOSIGNAL, way.to.get(), way.to.size);
    }
  }

  void say() const {
    const Counters& c = counters_;
    std::printf("{\"came\":%lld,\"lost\":%lld,\"doubled\":%lld,\"sent\":%lld,\"full\":%lld,", c.came, c.lost,
                c.doubled, c.sent, c.full);
    std::printf("\"replayed\":%lld,\"mutated\":%lld,\"forged\":%lld,\"flooded\":%lld}\n", c.replayed,
                c.mutated, c.forged, c.flooded);
  }

  void forward(std::size_t k, std::string bytes) {
    const double jitter = std::uniform_real_distribution<>(-1, 1)(ways_[k].random) * weather_.jitter_ms;
    const auto delay = static_cast<Micros>(1000 * std::max(0.0, weather_.delay_ms + jitter));
    if (delay == 0) return send(k, bytes);
    if (late_.size() < kMostWaiting)
      late_.push({now().steady + delay, k, std::move(bytes)});
    else
      ++counters_.full;
  }

  void send(std::size_t k, const std::string& bytes) {
    const Address& to = ways_[k].to;
    if (::sendto(ways_[k].from.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL, to.get(), to.size) >= 0)
      ++counters_.sent;
  }

  std::vector<Way> ways_;
  Weather weather_;
  std::priority_queue<Late> late_;
  Intruder intruder_;
  Counters counters_;
};

}  // namespace

int main(int count, char** words) {
  Weather weather;
  const std::tuple<const char*, double*, double> options[] = {
      {"--seed", &weather.seed, 9e15},          {"--loss", &weather.loss, 1},
      {"--duplicates", &weather.duplicates, 1}, {"--delay-ms", &weather.delay_ms, 1e4},
      {"--jitter-ms", &weather.jitter_ms, 1e4}, {"--replay", &weather.replay, 1},
      {"--mutate", &weather.mutate, 1},         {"--forge", &weather.forge, 1},
      {"--flood", &weather.flood, 1e6},         {"--seconds", &weather.seconds, 86400}};
  try {
    std::vector<Way> ways;
    for (int k = 1; k < count; ++k) {
      const std::string_view word = words[k];
      if (word == "--help") return std::fputs(kUsage, stdout), 0;
      bool option = false;
      for (const auto& [name, value, most] : options) {
        if (word != name || k + 1 >= count) continue;
        *value = number_of(word, words[++k], most);
        option = true;
      }
      if (!option)
        ways.push_back(way_of(word, static_cast<std::uint64_t>(weather.seed) * 1000 + ways.size()));
    }
    if (ways.empty()) return std::fputs(kUsage, stderr), 2;
    Relay(std::move(ways), weather).run();
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "garrison-relay: %s\n", error.what()), 2;
  }
}
