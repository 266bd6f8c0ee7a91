// SPDX-License-Identifier: Apache-2.0
#include "faults.hpp"

#include <algorithm>
#include <cmath>

namespace garrison::node::test {

namespace {
int anyone_of(int agents, Seeded& random) {
  return static_cast<int>(random.below(static_cast<std::size_t>(agents)));
}
}  // namespace

std::optional<Weather> weather_of(std::string_view word) {
  constexpr std::pair<std::string_view, Weather> all[] = {{"all", Weather::all},
                                                          {"cold", Weather::cold},
                                                          {"clock", Weather::clock},
                                                          {"liar", Weather::liar},
                                                          {"honest", Weather::honest}};
  for (const auto& [name, weather] : all)
    if (name == word) return weather;
  return {};
}

Faults::Faults(int agents, Seeded& random, Weather weather) : skew(static_cast<std::size_t>(agents), 0) {
  switch (weather) {
    case Weather::all:
    case Weather::honest:
      draw_anything(agents, random);
      if (weather == Weather::honest) liar = -1;
      return;
    case Weather::cold:
      loss = 0.1 * random.uniform();
      attacked = anyone_of(agents, random);
      draw_crashes(agents, random);
      return;
    case Weather::clock:
      for (Micros& s : skew) s = static_cast<Micros>(10000 * random.signed_unit());
      draw_hour(agents, random);
      return;
    case Weather::liar:
      loss = 0.1 * random.uniform();
      jitter = static_cast<Micros>(5000 * random.uniform());
      liar = anyone_of(agents, random);
  }
}

/// Power cuts from which nothing is left on the disk.
void Faults::draw_crashes(int agents, Seeded& random) {
  for (std::size_t k = 1 + random.below(4); k > 0; --k) {
    const auto at = static_cast<Micros>(1e6 * (1.5 + 4.5 * random.uniform()));
    const auto away = static_cast<Micros>(1e6 * 1.5 * random.uniform());
    crashes.push_back({at, at + away, anyone_of(agents, random), true});
  }
}

/// An hour forwards or back, for up to two seconds.
void Faults::draw_hour(int agents, Seeded& random) {
  const int node = anyone_of(agents, random);
  const Micros by = random.uniform() < 0.5 ? 3'600'000'000 : -3'600'000'000;
  const auto at = static_cast<Micros>(1e6 * (2 + 3 * random.uniform()));
  steps = {{at, by, node}, {at + static_cast<Micros>(1e6 * (0.05 + 2 * random.uniform())), -by, node}};
}

void Faults::draw_anything(int agents, Seeded& random) {
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
    for (Micros& s : skew) s = static_cast<Micros>(10000 * random.signed_unit());
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

}  // namespace garrison::node::test
